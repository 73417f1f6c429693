/// @file
/// An alert as a kind of product; each change of an alert is a product.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/supervision/alert.h"
#include "services/products/named.h"
#include "services/products/product_kind.h"

namespace spindrift {

inline std::optional<std::int64_t> tai_ns_if(const std::optional<TaiTime>& t) {
  return t ? std::optional{tai_ns(*t)} : std::nullopt;
}

struct AlertTable {
  static constexpr std::string_view kName = "alert";
  static constexpr std::array<std::string_view, 2> kKey{"raised_tai_ns", "alert_id"};
  static constexpr bool kOfSpacecraft = true;
  static constexpr std::string_view kReplaces = "excluded.revision > revision";
  static constexpr auto kColumns = columns(
      ProductColumn{"alert_id", &Alert::alert_id}, ProductColumn{"key", &Alert::key},
      ProductColumn{"severity", [](const Alert& alert) { return name_of(alert.severity); }},
      ProductColumn{"state", [](const Alert& alert) { return name_of(alert.state); }},
      ProductColumn{"revision", &Alert::revision},
      ProductColumn{"raised_tai_ns", [](const Alert& alert) { return tai_ns(alert.raised); }},
      ProductColumn{"updated_tai_ns", [](const Alert& alert) { return tai_ns(alert.updated); }},
      ProductColumn{"returned_tai_ns",
                    [](const Alert& alert) { return tai_ns_if(alert.returned); }},
      ProductColumn{"cleared_tai_ns", [](const Alert& alert) { return tai_ns_if(alert.cleared); }},
      ProductColumn{"shelved_until_tai_ns",
                    [](const Alert& alert) { return tai_ns_if(alert.shelved_until); }},
      ProductColumn{"accepted_by",
                    [](const Alert& alert) {
                      return alert.accepted ? std::optional{alert.accepted->by} : std::nullopt;
                    }},
      ProductColumn{"accepted_tai_ns",
                    [](const Alert& alert) {
                      return alert.accepted ? std::optional{tai_ns(alert.accepted->t)}
                                            : std::nullopt;
                    }},
      ProductColumn{"count", &Alert::count}, ProductColumn{"message", &Alert::message},
      ProductColumn{"evidence", &Alert::evidence});
};

struct AlertTransitionTable {
  static constexpr std::string_view kName = "alert_transition";
  static constexpr std::array<std::string_view, 3> kKey{"alert_id", "t_tai_ns", "to_state"};
  static constexpr auto kColumns = columns(
      ProductColumn{"alert_id", &Alert::alert_id},
      ProductColumn{"t_tai_ns", [](const Alert& alert) { return tai_ns(alert.updated); }},
      ProductColumn{"from_state",
                    [](const Alert& alert) {
                      return alert.from ? std::optional{name_of(*alert.from)} : std::nullopt;
                    }},
      ProductColumn{"to_state", [](const Alert& alert) { return name_of(alert.state); }},
      ProductColumn{"by", &Alert::by}, ProductColumn{"note", &Alert::note});
  /// A new message alone is no transition.
  static bool has_row(const Alert& alert) { return !alert.by.empty(); }
};

template <>
struct ProductKind<Alert> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<AlertTable, AlertTransitionTable>;
  static constexpr bool kStays = true;

  static constexpr const char* kTopic = "spindrift/alert";
  static constexpr bool is_announced(const Alert& /*alert*/) { return true; }
  static std::string_view instance(const Alert& alert) { return alert.key; }
  /// Does not depend on time, since a later run may process earlier telemetry. An alert has fewer
  /// than a million revisions.
  static std::int64_t number(const Alert& alert) {
    return alert.count * 1'000'000 + alert.revision;
  }
  static constexpr bool is_settled(const Alert& /*alert*/) { return true; }

  /// Restores an alert without its latest transition.
  template <class Row>
  static Alert from_row(const Row& row) {
    Alert alert;
    alert.alert_id = row.text("alert_id");
    alert.key = row.text("key");
    alert.severity = named(row.text("severity"), AlertSeverity::Critical);
    alert.state = named(row.text("state"), AlertState::Cleared);
    alert.revision = row.integer("revision");
    alert.raised = tai_from_ns(row.integer("raised_tai_ns"));
    alert.updated = tai_from_ns(row.integer("updated_tai_ns"));
    if (row.has("returned_tai_ns")) {
      alert.returned = tai_from_ns(row.integer("returned_tai_ns"));
    }
    if (row.has("accepted_by") && row.has("accepted_tai_ns")) {
      alert.accepted = Acknowledgement{.by = std::string{row.text("accepted_by")},
                                       .t = tai_from_ns(row.integer("accepted_tai_ns"))};
    }
    if (row.has("cleared_tai_ns")) {
      alert.cleared = tai_from_ns(row.integer("cleared_tai_ns"));
    }
    if (row.has("shelved_until_tai_ns")) {
      alert.shelved_until = tai_from_ns(row.integer("shelved_until_tai_ns"));
    }
    alert.count = row.integer("count");
    alert.message = row.text("message");
    alert.evidence = row.text("evidence");
    return alert;
  }
};

}  // namespace spindrift
