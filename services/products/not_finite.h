/// @file
/// Finds numbers in a product that are not finite.

#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/observation/normal_equations.h"
#include "services/products/product_kind.h"

namespace spindrift {

inline bool is_finite(double value) { return std::isfinite(value); }
inline bool is_finite(const std::optional<double>& value) {
  return !value || std::isfinite(*value);
}

inline bool is_finite(const Reason& reason) {
  return std::all_of(reason.values.begin(), reason.values.end(), [](const NamedValue& value) {
    const auto* const number = std::get_if<double>(&value.value);
    return number == nullptr || std::isfinite(*number);
  });
}

inline bool is_finite(const NormalEquations& equations) {
  return equations.b0.allFinite() && equations.n.allFinite() && equations.g.allFinite();
}

/// Place of a number that is not finite.
struct NotFinite {
  std::string_view table;
  std::string_view column;
};

/// Returns the first such place in the rows of a product; empty when all numbers are finite.
template <class Kind>
std::optional<NotFinite> not_finite(const Kind& product) {
  std::optional<NotFinite> found;
  const auto look = [&](std::string_view table, const auto& column, const auto& row) {
    using Value = std::remove_cvref_t<decltype(column.of(row))>;
    if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, std::optional<double>>) {
      if (!found && !is_finite(column.of(row))) {
        found = NotFinite{.table = table, .column = column.name};
      }
    }
  };
  // Reasons are text in their column, so their values are checked here.
  const auto look_at = [&](const std::vector<Reason>& reasons) {
    if (!std::all_of(reasons.begin(), reasons.end(),
                     [](const Reason& reason) { return is_finite(reason); })) {
      found = NotFinite{.table = MainTable<Kind>::kName, .column = "reasons"};
    }
  };
  if constexpr (requires { product.assessment; }) {
    look_at(product.assessment.reasons);
  } else if constexpr (requires { product->solution.assessment; }) {
    look_at(product->solution.assessment.reasons);
  } else if constexpr (std::is_same_v<Kind, NormalEquations>) {
    // These too are text in their columns.
    if (!is_finite(product)) {
      found = NotFinite{.table = MainTable<Kind>::kName, .column = "n"};
    }
  }
  for_each_table<Kind>([&]<class Table>() {
    for_each_row<Table>(product, [&](const auto& row) {
      with_columns<Table>([&](const auto&... column) { (look(Table::kName, column, row), ...); });
    });
  });
  return found;
}

}  // namespace spindrift
