#include "services/spindrift/pacing.h"

namespace spindrift {

void Pacing::wait_until_due(TaiTime t, const std::stop_token& stop) {
  if (!(speed_ > 0.0)) {
    return;
  }
  if (!first_) {
    first_ = t;
    start_ = Clock::now();
  }
  const std::chrono::duration<double> elapsed{seconds_between(*first_, t) / speed_};
  std::unique_lock lock{mutex_};
  stopped_.wait_until(lock, stop, start_ + std::chrono::duration_cast<Clock::duration>(elapsed),
                      [] { return false; });
}

}  // namespace spindrift
