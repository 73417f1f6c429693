#include "pipelines/spin/types/revolution.h"

#include "pipelines/frames/angle.h"
#include "pipelines/time/time_span.h"

namespace spindrift {

double Revolution::rate_rad_s(TaiTime t) const {
  return kTurn_rad * (1.0 / period.period_s + period.drift_per_s2 * elapsed_s(t_start, t));
}

double Revolution::turned_rad(TaiTime from, TaiTime to) const {
  return rate_rad_s(from + (to - from) / 2) * elapsed_s(from, to);
}

}  // namespace spindrift
