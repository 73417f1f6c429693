#include "pipelines/ground_model/link/coded_telemetry.h"

#include <cmath>
#include <optional>
#include <utility>

#include "pipelines/spin/types/spin_rate.h"

namespace spindrift {
namespace {

/// Rounds to nanoseconds, the double that a telemetry file reads back as.
double on_nanosecond(double interval_s) { return std::round(interval_s * 1e9) / 1e9; }

class OnBoardCounter {
 public:
  explicit OnBoardCounter(double resolution_s) : resolution_s_{resolution_s} {}

  /// @param sent_down Whether the link carries the pulse.
  void count(const Pulse& pulse, bool sent_down) {
    if (pulse.channel == PulseChannel::Sun1) {
      const CodedFrame next{.t = pulse.t, .period_s = period_until(pulse.t), .delay_s = {}};
      close();
      open_ = next;
      whole_ = sent_down;
    } else if (open_) {
      auto& delay_s = open_->delay_s.at(index_of(pulse.channel));
      delay_s = delay_s ? delay_s : delay_at(pulse.t);
      whole_ = whole_ && sent_down;
    }
  }

  std::vector<CodedFrame> frames() && {
    close();
    return std::move(frames_);
  }

 private:
  /// Returns the counted interval since the frame was opened; empty beyond the counter's range.
  std::optional<double> counted(TaiTime t) const {
    const double ticks = std::round(seconds_between(open_->t, t) / resolution_s_);
    const double interval_s = on_nanosecond(ticks * resolution_s_);
    return interval_s <= kLongestPeriod_s ? std::optional{interval_s} : std::nullopt;
  }

  std::optional<double> period_until(TaiTime t) const {
    const auto period_s = open_ ? counted(t) : std::nullopt;
    return period_s > 0.0 ? period_s : std::nullopt;
  }

  std::optional<double> delay_at(TaiTime t) const {
    const auto delay_s = counted(t);
    return delay_s && open_->period_s ? on_nanosecond(std::fmod(*delay_s, *open_->period_s))
                                      : delay_s;
  }

  void close() {
    if (open_ && whole_) {
      frames_.push_back(*open_);
    }
    open_.reset();
  }

  double resolution_s_;
  std::optional<CodedFrame> open_;
  bool whole_ = true;  ///< True while no edge of `open_` has fallen in a silence.
  std::vector<CodedFrame> frames_;
};

}  // namespace

std::vector<CodedFrame> coded_telemetry(const ReceivedPass& pass, double resolution_s) {
  OnBoardCounter counter{resolution_s};
  auto silenced = pass.silenced.begin();
  const auto see_silenced_until = [&](auto is_later) {
    for (; silenced != pass.silenced.end() && !is_later(*silenced); ++silenced) {
      counter.count(*silenced, false);
    }
  };
  for (const ReceivedPulse& received : pass.pulses) {
    see_silenced_until([&](const Pulse& pulse) { return pulse.t > received.pulse.t; });
    counter.count(received.pulse, true);
  }
  see_silenced_until([](const Pulse&) { return false; });
  return std::move(counter).frames();
}

}  // namespace spindrift
