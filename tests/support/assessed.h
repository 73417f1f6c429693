/// @file
/// Queries on the reasons and notices of an assessment.

#pragma once

#include <algorithm>
#include <variant>

#include "pipelines/core/assessment.h"
#include "pipelines/core/notice.h"

namespace spindrift::testing {

/// Returns whether the estimator `sequential` gave up an earlier axis.
inline bool restarted(const Assessment& assessment) {
  return has(assessment, ReasonCode::RestartedGated) ||
         has(assessment, ReasonCode::RestartedByFixes);
}

/// Returns the value called `name` of the first reason or notice with this code; -1 if there is
/// none, or if it has no such number.
template <class Said, class Code>
double number_of(const std::vector<Said>& said, Code code, std::string_view name) {
  for (const Said& one : said) {
    for (const NamedValue& value : one.values) {
      if (one.code == code && value.name == name) {
        const auto* const real = std::get_if<double>(&value.value);
        const auto* const whole = std::get_if<std::int64_t>(&value.value);
        return real != nullptr ? *real : whole != nullptr ? static_cast<double>(*whole) : -1.0;
      }
    }
  }
  return -1.0;
}

inline bool has(const std::vector<Notice>& notices, NoticeCode code) {
  return std::any_of(notices.begin(), notices.end(),
                     [code](const Notice& notice) { return notice.code == code; });
}

}  // namespace spindrift::testing
