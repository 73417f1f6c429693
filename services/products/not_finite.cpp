#include "services/products/not_finite.h"

#include <cmath>
#include <type_traits>

namespace spindrift {
namespace {

bool is_finite(double value) { return std::isfinite(value); }
bool is_finite(const std::optional<double>& value) { return !value || std::isfinite(*value); }

template <class Table, class Kind>
void look(const Kind& product, std::optional<NotFinite>& found) {
  for_each_row<Table>(product, [&](const auto& row) {
    const auto see = [&]<class Get>(const ProductColumn<Get>& column) {
      using Value = std::invoke_result_t<Get, decltype(row)>;
      if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, std::optional<double>>) {
        if (!found && !is_finite(column.get(row))) {
          found = NotFinite{.table = Table::kName, .column = column.name};
        }
      }
    };
    with_columns<Table>([&](const auto&... column) { (see(column), ...); });
  });
}

}  // namespace

std::optional<NotFinite> not_finite(const Product& product) {
  std::optional<NotFinite> found;
  std::visit(
      [&]<class Kind>(const Kind& value) {
        for_each_table<Kind>([&]<class Table>() { look<Table>(value, found); });
      },
      product);
  return found;
}

}  // namespace spindrift
