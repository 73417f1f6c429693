/// @file
/// A sample of a three-axis spacecraft that its pass left out, as a kind of product.

#pragma once

#include <array>
#include <string_view>
#include <tuple>

#include "pipelines/three_axis/products.h"
#include "services/products/product_kind.h"

namespace spindrift {

struct RejectedSampleTable {
  static constexpr std::string_view kName = "rejected_sample";
  static constexpr std::array<std::string_view, 2> kKey{"t_tai_ns", "kind"};
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const RejectedSample& sample) { return tai_ns(sample.t); }},
      ProductColumn{"kind", [](const RejectedSample& sample) { return name_of(sample.kind); }},
      ProductColumn{"rejected_by",
                    [](const RejectedSample& sample) { return name_of(sample.rejected_by); }},
      ProductColumn{"squared_innovation",
                    [](const RejectedSample& sample) { return sample.squared_innovation; }});
  /// A sample that is late is not said to be so when something else has become of it: it arrived
  /// twice.
  static constexpr std::string_view kReplaces = "excluded.rejected_by <> 'late'";
};

template <>
struct ProductKind<RejectedSample> {
  /// Stored with the attitudes between which it lies, so that a restarted service goes on where the
  /// last of them is.
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<RejectedSampleTable>;
};

}  // namespace spindrift
