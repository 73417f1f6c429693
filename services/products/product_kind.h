/// @file
/// Traits of each kind of product, and iteration over its rows.

#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace spindrift {

/// Results are announced or awaited by somebody. Details support the results: they are not
/// announced, and nobody waits for them.
enum class ProductWeight { Result, Detail };

/// A column by name, with a function or member that gives its value of a row: a std::int64_t,
/// double, bool or std::string, a std::string_view of a literal, or a std::optional of one of
/// these.
template <class Get>
struct ProductColumn {
  std::string_view name;
  Get get;

  template <class Row>
  constexpr decltype(auto) of(const Row& row) const {
    return std::invoke(get, row);
  }
};
template <class Get>
ProductColumn(std::string_view, Get) -> ProductColumn<Get>;

/// Calls `see(column...)`. A std::tuple of so many types is slow to compile.
template <class... Get>
constexpr auto columns(ProductColumn<Get>... column) {
  return [=](const auto& see) { return see(column...); };
}

/// Traits of a kind of product, with
///   kWeight        a ProductWeight
///   Tables         a std::tuple of its tables; the first has one row per product
/// and, if products of the kind are announced,
///   kTopic         topic on the bus; or instead
///   announced_as   products of kinds with a topic to announce, in their order
///   is_announced   whether this product is announced
///   instance       instance on the bus, per spacecraft: only its latest product is in force
///   number         rises within an instance; the same number means a repeated product
///   is_settled     whether it will not be given again with another answer
///   from_row       restores the product from its row in the archive; and from the rows of
///   Parts          a second table, if defined
/// and optionally
///   kStays         true: it is never withdrawn in part, but replaced by a later product
///   without_residuals  the product as stored by runs that do not store residuals
///
/// A table has
///   kName
///   kKey           columns that identify its rows within a run, in the order of
///   kColumns       its columns, from columns(ProductColumn...)
/// and optionally
///   kOfSpacecraft  true: the spacecraft's column follows the run's
///   kOfResiduals   true: it has no rows of runs that do not store residuals
///   kSaysWhenAnnounced  true: in live runs the column announced_utc follows the run's
///   kCondition     SQL condition that selects its rows from those of other kinds in the table
///   kReplaces      SQL condition under which a row replaces one with the same key
///   rows(product)  a range of rows to which the columns apply, if there may be none or many; then
///   group(product) is the value of the first key column in all of them: stored rows of the
///                  group are removed first
///   has_row(product)  whether there is a row
///   t_tai_ns(product)  its time, as in the main table: only rows of the latest product are kept
template <class Product>
struct ProductKind;

template <class Product>
using MainTable = std::tuple_element_t<0, typename ProductKind<Product>::Tables>;

template <class Product>
concept AnnouncedProduct = requires {
  &ProductKind<Product>::is_announced;
};
template <class Product>
concept PublishedProduct = requires {
  ProductKind<Product>::kTopic;
};

/// Calls `see.template operator()<Table>()` for each table of a kind, the main one first.
template <class Product, class See>
constexpr void for_each_table(const See& see) {
  [&]<class... Table>(std::type_identity<std::tuple<Table...>> /*tables*/) {
    (see.template operator()<Table>(), ...);
  }(std::type_identity<typename ProductKind<Product>::Tables>{});
}

/// Calls `see(column...)` with the columns of `Table`.
template <class Table, class See>
constexpr auto with_columns(const See& see) {
  return Table::kColumns(see);
}

template <class Table>
constexpr bool has_column(std::string_view name) {
  return with_columns<Table>(
      [name](const auto&... column) { return (... || (column.name == name)); });
}

/// Index of a column in `Table`; an unknown name does not compile.
template <class Table>
struct ColumnOf {
  int index = 0;

  // Implicit, so that a name can stand for its column.
  consteval ColumnOf(const char* name)  // NOLINT(google-explicit-constructor)
      : index{with_columns<Table>([name](const auto&... column) {
          const std::array<std::string_view, sizeof...(column)> names{column.name...};
          const auto found = std::find(names.begin(), names.end(), name);
          if (found == names.end()) {
            throw "the table has no such column";
          }
          return static_cast<int>(found - names.begin());
        })} {}
};

/// Calls `see` with each row that `product` has in `Table`.
template <class Table, class Product, class See>
void for_each_row(const Product& product, const See& see) {
  if constexpr (requires { Table::rows(product); }) {
    for (const auto& row : Table::rows(product)) {
      see(row);
    }
  } else if constexpr (requires { Table::has_row(product); }) {
    if (Table::has_row(product)) {
      see(product);
    }
  } else {
    see(product);
  }
}

}  // namespace spindrift
