#include <dds/dds.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <string_view>
#include <thread>
#include <utility>

#include "services/bus/builtin_topics.h"
#include "services/bus/qos.h"
#include "services/bus/topics.h"
#include "services/doctor/presence.h"
#include "services/products/products.h"

namespace spindrift::doctor {
namespace {

// Participants answer the announcement of a newcomer at once.
constexpr std::chrono::seconds kListening{1};
constexpr std::string_view kOurTopics = "spindrift/";

/// Identifier of a participant, by which endpoints refer to it.
using Guid = std::string;

Guid guid_of(const dds_guid_t& guid) { return fmt::format("{:02x}", fmt::join(guid.v, "")); }

std::string this_host() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return host.data();
}

Expected<std::map<Guid, std::string>> participants_of(const bus::Participant& participant,
                                                      pid_t partner) {
  std::map<Guid, std::string> participants;
  const auto note = [&, host = this_host()](const dds_builtintopic_participant_t& present) {
    const std::string pid = bus::property(present.qos, "__Pid");
    const std::string at = bus::property(present.qos, "__Hostname");
    if (at == host && (pid == std::to_string(getpid()) || pid == std::to_string(partner))) {
      return;
    }
    participants[guid_of(present.key)] =
        fmt::format("{} (pid {}) on {}", bus::property(present.qos, "__ProcessName"), pid, at);
  };
  return bus::for_each_present<dds_builtintopic_participant_t>(
             participant.handle(), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, note)
      .map([&] { return std::move(participants); });
}

bool is_result(std::string_view topic) {
  bool is_one = topic == bus::kHealthTopic.name;
  for_each_product_kind([&]<class Kind>() {
    if constexpr (PublishedProduct<Kind>) {
      is_one = is_one || topic == ProductKind<Kind>::kTopic;
    }
  });
  return is_one;
}

std::vector<bus::Shortfall> shortfalls_of(std::string_view topic, bool writes,
                                          const dds_qos_t* qos) {
  if (writes) {
    const bus::Qos ours = is_result(topic) ? bus::results_qos() : bus::telemetry_reader_qos();
    return bus::shortfalls(qos, ours.get());
  }
  const bus::Qos ours = is_result(topic) ? bus::results_qos() : bus::telemetry_writer_qos();
  return bus::shortfalls(ours.get(), qos);
}

/// Adds the readers or writers whose owners are known.
Expected<void> add_endpoints(const bus::Participant& participant,
                             const std::map<Guid, std::string>& owners, bool writes,
                             std::vector<Endpoint>& endpoints) {
  const auto note = [&](const dds_builtintopic_endpoint_t& present) {
    const std::string_view topic = present.topic_name;
    const auto owner = owners.find(guid_of(present.participant_key));
    if (topic.starts_with(kOurTopics) && owner != owners.end()) {
      endpoints.push_back({.writes = writes,
                           .topic = std::string{topic},
                           .partitions = bus::partitions_of(present.qos),
                           .owner = owner->second,
                           .shortfalls = shortfalls_of(topic, writes, present.qos)});
    }
  };
  return bus::for_each_present<dds_builtintopic_endpoint_t>(
      participant.handle(),
      writes ? DDS_BUILTIN_TOPIC_DCPSPUBLICATION : DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, note);
}

}  // namespace

Expected<PresenceFacts> presence_facts(const bus::BusConfig& bus, pid_t partner) {
  const auto participant = bus::Participant::create(bus);
  if (!participant) {
    return Unexpected{participant.error()};
  }
  std::this_thread::sleep_for(kListening);
  const auto participants = participants_of(*participant, partner);
  if (!participants) {
    return Unexpected{participants.error()};
  }
  PresenceFacts facts{.bus = bus, .participants = {}, .endpoints = {}};
  for (const auto& [guid, description] : *participants) {
    facts.participants.push_back(description);
  }
  for (const bool writes : {true, false}) {
    if (auto added = add_endpoints(*participant, *participants, writes, facts.endpoints); !added) {
      return Unexpected{added.error()};
    }
  }
  return facts;
}

}  // namespace spindrift::doctor
