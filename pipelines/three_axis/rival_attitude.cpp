#include "pipelines/three_axis/rival_attitude.h"

#include <algorithm>

#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

// Samples beyond this number do not make a verdict any surer, nor harder to turn.
constexpr int kMostAgainst = 10;

}  // namespace

bool RivalAttitude::hear(const ObservedAttitude& fix, bool fits, bool fits_in_force) {
  if (fits_in_force) {
    star_fixes = 0;
  } else if (fits) {
    filter.update(fix);
    ++star_fixes;
  }
  const bool is_past = fits_in_force || (!fits && !(stands() && is_refuted()));
  return was_in_force || !is_past;
}

bool RivalAttitude::hear(const SeenDirection& seen, bool fits, bool fits_in_force) {
  against =
      std::clamp(against + (fits_in_force ? 1 : 0) - (fits ? 1 : 0), -kMostAgainst, kMostAgainst);
  if (fits) {
    filter.update(seen);
  }
  return !(was_in_force && is_refuted());
}

bool RivalAttitude::overrules(TaiTime t, bool is_confirmed) const {
  if (is_refuted() || star_fixes < kEnough) {
    return false;
  }
  return was_in_force || !is_confirmed || elapsed_s(since, t) >= kDecided_s;
}

}  // namespace spindrift
