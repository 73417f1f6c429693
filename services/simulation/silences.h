/// @file
/// The silences of a scenario.

#pragma once

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "pipelines/ground_model/link/silence.h"
#include "services/mission/scalar.h"
#include "services/mission/values.h"

namespace spindrift {

/// @param tables Key of an array of tables, e.g. "faults.silence".
inline std::vector<Silence> silences_of(const TomlValues& values, std::string_view tables) {
  std::vector<Silence> all;
  for (int i = 0;; ++i) {
    const auto from_s = value_if<double>(values, fmt::format("{}[{}].from_s", tables, i));
    if (!from_s) {
      return all;
    }
    all.push_back(
        {.from_s = *from_s, .to_s = number(values, fmt::format("{}[{}].to_s", tables, i))});
  }
}

}  // namespace spindrift
