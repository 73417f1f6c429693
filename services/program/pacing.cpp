#include "services/program/pacing.h"

namespace spindrift {

std::optional<Pacing::Clock::time_point> Pacing::due(TaiTime t) {
  if (!(speed_ > 0.0)) {
    return std::nullopt;
  }
  const Clock::time_point now = Clock::now();
  if (!first_) {
    first_ = t;
    start_ = now;
  }
  const std::chrono::duration<double> elapsed{seconds_between(*first_, t) / speed_};
  const Clock::time_point due = start_ + std::chrono::duration_cast<Clock::duration>(elapsed);
  return due > now ? std::optional{due} : std::nullopt;
}

void Pacing::wait_until(Clock::time_point due, const std::stop_token& stop) {
  std::unique_lock lock{mutex_};
  stopped_.wait_until(lock, stop, due, [] { return false; });
}

}  // namespace spindrift
