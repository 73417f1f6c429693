/// @file
/// A failure of the computation, as a kind of product.

#pragma once

#include <array>
#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/time/tai_time.h"
#include "services/products/product_kind.h"

namespace spindrift {

struct RunFault {
  TaiTime t = {};         ///< Time of the sample, or of the last edge in a batch solution.
  std::string what = {};  ///< Text of the exception.
};

struct RunFaultTable {
  static constexpr std::string_view kName = "run_fault";
  static constexpr std::array<std::string_view, 1> kKey{"t_tai_ns"};
  static constexpr auto kColumns =
      columns(ProductColumn{"t_tai_ns", [](const RunFault& fault) { return tai_ns(fault.t); }},
              ProductColumn{"what", &RunFault::what});
};

template <>
struct ProductKind<RunFault> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<RunFaultTable>;
};

}  // namespace spindrift
