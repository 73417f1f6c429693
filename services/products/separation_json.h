/// @file
/// Converts the verdict on a separation to a JSON object.

#pragma once

#include <nlohmann/json.hpp>

#include "pipelines/time/utc.h"
#include "services/products/pass_verdict.h"

namespace spindrift {

inline nlohmann::json separation_json(const SeparationVerdict& verdict) {
  return {{"method", verdict.method},       {"quality", name_of(verdict.quality)},
          {"t_tai_ns", tai_ns(verdict.t1)}, {"utc", format_utc(verdict.t1)},
          {"sigma_deg", verdict.sigma_deg}, {"why", verdict.why}};
}

}  // namespace spindrift
