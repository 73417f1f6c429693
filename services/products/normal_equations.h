/// @file
/// What a run says of the values of its mission file, as a kind of product.

#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/observation/normal_equations.h"
#include "services/products/product_kind.h"

namespace spindrift {

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

  using Row = NormalEquations;
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const Row& row) { return tai_ns(row.t); }},
      ProductColumn{"names", [](const Row& row) { return nlohmann::json(row.names).dump(); }},
      ProductColumn{"b0", [](const Row& row) { return json_array(row.b0); }},
      ProductColumn{"n", [](const Row& row) { return json_array(row.n); }},
      ProductColumn{"g", [](const Row& row) { return json_array(row.g); }});
};

template <>
struct ProductKind<NormalEquations> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<NormalEquationsTable>;
};

}  // namespace spindrift
