#include "pipelines/ground_model/coded_telemetry.h"

#include <cmath>

namespace spindrift {
namespace {

/// The double nearest to so many nanoseconds: what a file of telemetry reads back as.
double on_nanosecond(double interval_s) { return std::round(interval_s * 1e9) / 1e9; }

double on_grid(double interval_s, double resolution_s) {
  return on_nanosecond(std::round(interval_s / resolution_s) * resolution_s);
}

}  // namespace

std::vector<CodedFrame> coded_telemetry(const std::vector<ReceivedPulse>& pulses,
                                        double resolution_s) {
  std::vector<CodedFrame> frames;
  for (const auto& [pulse, damage] : pulses) {
    if (pulse.channel == PulseChannel::Sun1) {
      CodedFrame frame{.t = pulse.t, .period_s = {}, .delay_s = {}};
      if (!frames.empty()) {
        frame.period_s = on_grid(seconds_between(frames.back().t, pulse.t), resolution_s);
      }
      frames.push_back(frame);
    } else if (!frames.empty() && !frames.back().delay_s.at(index_of(pulse.channel))) {
      const CodedFrame& frame = frames.back();
      const double delay_s = on_grid(seconds_between(frame.t, pulse.t), resolution_s);
      const bool modulo = frame.period_s && *frame.period_s > 0.0;
      frames.back().delay_s.at(index_of(pulse.channel)) =
          modulo ? on_nanosecond(std::fmod(delay_s, *frame.period_s)) : delay_s;
    }
  }
  return frames;
}

}  // namespace spindrift
