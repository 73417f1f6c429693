/// @file
/// What a run says of the values of its mission file, as a kind of product.

#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/statistics/normal_equations.h"
#include "pipelines/time/tai_time.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// The normal equations of the last solution of a run, whose time they have.
struct RunNormalEquations {
  TaiTime t = {};
  NormalEquations equations = {};
};

/// Returns a JSON array of the elements, of a matrix row by row.
template <class Matrix>
std::string json_array(const Matrix& matrix) {
  nlohmann::json elements = nlohmann::json::array();
  for (const auto row : matrix.rowwise()) {
    for (const double element : row) {
      elements.push_back(element);
    }
  }
  return elements.dump();
}

struct NormalEquationsTable {
  static constexpr std::string_view kName = "normal_equations";
  static constexpr std::array<std::string_view, 1> kKey{"run_id"};
  static constexpr std::string_view kReplaces = "excluded.t_tai_ns >= normal_equations.t_tai_ns";

  using Row = RunNormalEquations;
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const Row& row) { return tai_ns(row.t); }},
      ProductColumn{"names",
                    [](const Row& row) { return nlohmann::json(row.equations.names).dump(); }},
      ProductColumn{"b0", [](const Row& row) { return json_array(row.equations.b0); }},
      ProductColumn{"n", [](const Row& row) { return json_array(row.equations.n); }},
      ProductColumn{"g", [](const Row& row) { return json_array(row.equations.g); }});
};

template <>
struct ProductKind<RunNormalEquations> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<NormalEquationsTable>;
};

}  // namespace spindrift
