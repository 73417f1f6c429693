/// @file
/// Converts a product to a JSON object of its columns, null where a value is missing.

#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <type_traits>

#include "services/products/product_kind.h"

namespace spindrift {

/// Converts a row of `Table`.
template <class Table, class Row>
nlohmann::json json_of_row(const Row& row) {
  nlohmann::json object = nlohmann::json::object();
  const auto put = [&]<class Value>(std::string_view name, const Value& value) {
    if constexpr (requires { value.has_value(); }) {
      object[std::string{name}] = value ? nlohmann::json(*value) : nlohmann::json{};
    } else {
      object[std::string{name}] = value;
    }
  };
  with_columns<Table>([&](const auto&... column) { (put(column.name, column.of(row)), ...); });
  return object;
}

/// Converts a product's row in its main table.
template <class Product>
nlohmann::json json_of(const Product& product) {
  return json_of_row<MainTable<Product>>(product);
}

}  // namespace spindrift
