#include "services/bus/policies.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace spindrift::bus {
namespace {

constexpr std::array<std::string_view, 2> kReliability = {"BEST_EFFORT", "RELIABLE"};
constexpr std::array<std::string_view, 4> kDurability = {"VOLATILE", "TRANSIENT_LOCAL", "TRANSIENT",
                                                         "PERSISTENT"};
constexpr std::array<std::string_view, 2> kOwnership = {"SHARED", "EXCLUSIVE"};
constexpr std::array<std::string_view, 3> kLiveliness = {"AUTOMATIC", "MANUAL_BY_PARTICIPANT",
                                                         "MANUAL_BY_TOPIC"};
constexpr std::array<std::string_view, 2> kDestinationOrder = {"BY_RECEPTION_TIMESTAMP",
                                                               "BY_SOURCE_TIMESTAMP"};

/// The policies that a reader may request, with the DDS defaults for unset ones.
struct Policies {
  explicit Policies(const dds_qos_t* qos) {
    dds_duration_t blocking_ns = 0;
    dds_qget_reliability(qos, &reliability, &blocking_ns);
    dds_qget_durability(qos, &durability);
    dds_qget_ownership(qos, &ownership);
    dds_qget_deadline(qos, &deadline_ns);
    dds_qget_latency_budget(qos, &latency_ns);
    dds_qget_liveliness(qos, &liveliness, &lease_ns);
    dds_qget_destination_order(qos, &order);
  }

  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_ownership_kind_t ownership = DDS_OWNERSHIP_SHARED;
  dds_duration_t deadline_ns = DDS_INFINITY;
  dds_duration_t latency_ns = 0;
  dds_liveliness_kind_t liveliness = DDS_LIVELINESS_AUTOMATIC;
  dds_duration_t lease_ns = DDS_INFINITY;
  dds_destination_order_kind_t order = DDS_DESTINATIONORDER_BY_RECEPTION_TIMESTAMP;
};

std::string duration_text(std::string_view policy, dds_duration_t duration_ns) {
  return duration_ns == DDS_INFINITY
             ? fmt::format("no {}", policy)
             : fmt::format("{} {} s", policy, static_cast<double>(duration_ns) * 1e-9);
}

}  // namespace

std::vector<Shortfall> shortfalls(const dds_qos_t* offered, const dds_qos_t* needed) {
  const Policies offer{offered};
  const Policies need{needed};
  std::vector<Shortfall> found;
  const auto check_kind = [&found](const auto& names, auto offered_kind, auto needed_kind,
                                   bool enough) {
    if (!enough) {
      found.push_back({.offered = std::string{names.at(offered_kind)},
                       .needed = std::string{names.at(needed_kind)}});
    }
  };
  const auto check_duration = [&found](std::string_view policy, dds_duration_t offered_ns,
                                       dds_duration_t needed_ns) {
    if (offered_ns > needed_ns) {
      found.push_back({.offered = duration_text(policy, offered_ns),
                       .needed = duration_text(policy, needed_ns)});
    }
  };
  check_kind(kReliability, offer.reliability, need.reliability,
             offer.reliability >= need.reliability);
  check_kind(kDurability, offer.durability, need.durability, offer.durability >= need.durability);
  check_kind(kOwnership, offer.ownership, need.ownership, offer.ownership == need.ownership);
  check_duration("deadline", offer.deadline_ns, need.deadline_ns);
  check_duration("latency budget", offer.latency_ns, need.latency_ns);
  check_kind(kLiveliness, offer.liveliness, need.liveliness, offer.liveliness >= need.liveliness);
  check_duration("liveliness lease", offer.lease_ns, need.lease_ns);
  check_kind(kDestinationOrder, offer.order, need.order, offer.order >= need.order);
  return found;
}

}  // namespace spindrift::bus
