/// @file
/// The gates that say what an attitude is good for, and the one machine that decides each of them:
/// K hits among the W samples of a window.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/time/tai_time.h"
#include "pipelines/time/time_span.h"

namespace spindrift {

enum class Gate : std::uint8_t {
  Lost,    ///< The body is away from its nominal attitude.
  Usable,  ///< The innovations of the filter are small.
  Safe,    ///< The attitude of the filter may be acted on.
  Reached  ///< The attitude in force is the nominal one.
};
inline constexpr std::size_t kGates = 4;
constexpr std::string_view name_of(Gate gate) {
  constexpr std::array<std::string_view, kGates> kNames = {"lost", "usable", "safe", "reached"};
  return kNames.at(static_cast<std::size_t>(gate));
}

/// Says what a gate counts as a hit, and which windows open it. A window ends with the sample by
/// which it has both its samples and its length.
struct GateRule {
  double threshold;       ///< Lost: a hit is above it. All others: below.
  std::string_view unit;  ///< Unit of the threshold and of the values.
  int samples;            ///< W
  double seconds;         ///< W in time.
  double share;           ///< R: more than this share of hits opens the gate.
};

/// The threshold of `safe` is that of the normalised innovation squared, one of its conditions; its
/// window has at least as many samples as that of `usable`, so that sparse ones do not open it.
constexpr GateRule rule_of(Gate gate) {
  constexpr std::array<GateRule, kGates> kRules{{
      {.threshold = 5.0, .unit = "deg", .samples = 10, .seconds = 0.0, .share = 0.6},
      {.threshold = 1000.0, .unit = "nT", .samples = 30, .seconds = 0.0, .share = 0.67},
      {.threshold = 7.81, .unit = "1", .samples = 30, .seconds = 600.0, .share = 0.85},
      {.threshold = 6.0, .unit = "deg", .samples = 10, .seconds = 0.0, .share = 0.67},
  }};
  return kRules.at(static_cast<std::size_t>(gate));
}

/// That a gate opened or closed.
struct GateTransition {
  TaiTime t = {};
  Gate gate = Gate::Lost;
  bool open = false;
  double value = 0.0;  ///< Value of the sample that ended the window, in the unit of the rule.
  TaiTime since = {};  ///< First sample of the window.
  int hits = 0;        ///< K
  int window = 0;      ///< Samples of the window.
  std::vector<NamedValue> more = {};  ///< Whatever else the gate has known.
};

/// The machine. While a gate is closed the first hit opens a window and counts one; at the end of
/// the window the gate opens if the share of hits is above R, and the count begins anew. Windows do
/// not overlap. While the gate is open one window follows the other, whether it begins with a hit
/// or not, and a window that would not have opened the gate closes it. An open gate thus says what
/// its last whole window showed. If it waited for a hit as a closed one does, a body that was lost
/// and has recovered, of which no more hits come, would remain lost.
class WindowGate {
 public:
  struct Count {
    TaiTime since = {};
    int hits = 0;
    int samples = 0;
  };

  explicit WindowGate(const GateRule& rule) : rule_{rule} {}

  bool is_open() const { return is_open_; }

  /// Takes the next sample in order of time.
  /// @return The window that opened or closed the gate, if this sample ended one that did.
  std::optional<Count> update(TaiTime t, bool is_hit) {
    if (count_.samples == 0) {
      if (!is_hit && !is_open_) {
        return std::nullopt;
      }
      count_.since = t;
    }
    ++count_.samples;
    count_.hits += is_hit ? 1 : 0;
    if (count_.samples < rule_.samples || elapsed_s(count_.since, t) < rule_.seconds) {
      return std::nullopt;
    }
    const Count ended = std::exchange(count_, {});
    const bool opens = static_cast<double>(ended.hits) / ended.samples > rule_.share;
    return std::exchange(is_open_, opens) == opens ? std::nullopt : std::optional{ended};
  }

 private:
  GateRule rule_;
  bool is_open_ = false;
  Count count_;  ///< Of the window that is not ended; no samples: there is none.
};

}  // namespace spindrift
