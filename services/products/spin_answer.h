/// @file
/// The answer in force of a spinner, as a kind of product.

#pragma once

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/frames/angle.h"
#include "pipelines/supervision/answer_in_force.h"
#include "services/products/product_kind.h"

namespace spindrift {

struct SpinAnswerTable {
  static constexpr std::string_view kName = "spin_answer";
  static constexpr std::array<std::string_view, 1> kKey{"run_id"};
  /// Solutions in the background are stored by another thread than all others.
  static constexpr std::string_view kReplaces = "excluded.t_tai_ns >= spin_answer.t_tai_ns";

  /// Says which answers contradict each other; empty when none do.
  static std::string against(const SpinAnswer& answer) {
    std::string text;
    for (const AxesApart& pair : answer.contradictions) {
      text += fmt::format("{}{} and {} disagree by {:.3f} deg, {:.1f} sigma",
                          text.empty() ? "" : "; ", name_of(pair.one), name_of(pair.other),
                          pair.apart_rad * kDegPerRad, pair.sigmas);
    }
    return text;
  }
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const SpinAnswer& answer) { return tai_ns(answer.t); }},
      ProductColumn{"estimator",
                    [](const SpinAnswer& answer) { return name_of(answer.estimate.estimator); }},
      ProductColumn{"estimate_tai_ns",
                    [](const SpinAnswer& answer) { return tai_ns(answer.estimate.t); }},
      ProductColumn{"quality", [](const SpinAnswer& answer) { return name_of(answer.quality); }},
      ProductColumn{"against", &SpinAnswerTable::against});
};

template <>
struct ProductKind<SpinAnswer> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<SpinAnswerTable>;
};

}  // namespace spindrift
