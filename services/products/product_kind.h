/// @file
/// What is said of each kind of product, and how to go over its rows.

#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace spindrift {

/// Results are announced, or wait for by somebody; details are what results rest on: announced to
/// nobody, and not to be waited for.
enum class ProductWeight { Result, Detail };

/// `name` of a column, and how its value is had from a row: a std::int64_t, double, bool or
/// std::string, a std::string_view of a literal, or a std::optional of one of these.
template <class Get>
struct ProductColumn {
  std::string_view name;
  Get get;
};
template <class Get>
ProductColumn(std::string_view, Get) -> ProductColumn<Get>;

/// What calls `see(column...)`. A std::tuple of so many types takes long to compile.
template <class... Get>
constexpr auto columns(ProductColumn<Get>... column) {
  return [=](const auto& see) { return see(column...); };
}

/// Specialised for each kind, with
///   kWeight        a ProductWeight
///   Tables         a std::tuple of its tables; the first has one row a product
/// and, of those that are announced,
///   kTopic         on the bus; or
///   announced_as   products of kinds with a topic, in their order, in its place
///   is_announced   whether this one is
///   instance       of the bus, beside the spacecraft: of each only the latest is in force
///   number         rises within an instance: the same number is the same product, given again
///   is_settled     whether it will not be given again with another answer
///   from_row       the product as the archive has it; with
///   Parts          a table of which it is given its rows besides
/// and where it needs it
///   kStays         true: it is not withdrawn in part, but stays until another takes its place
///   without_residuals  what is stored of it by runs that do not store residuals
///
/// A table has
///   kName
///   kKey           columns that, behind the run's, tell its rows apart; in the order of their
///   kColumns       its columns, from columns(ProductColumn...)
/// and where it needs them
///   kOfSpacecraft  true: the spacecraft's column stands behind the run's
///   kOfResiduals   true: it has no rows of runs that do not store residuals
///   kSaysWhenAnnounced  true: the column announced_utc stands behind the run's, of live runs
///   kCondition     an SQL condition that tells its rows from those of other kinds there
///   kReplaces      an SQL condition on which a row takes the place of one with the same key
///   rows(product)  a range of rows to which the columns apply: the product has none or many. Then
///   group(product) is the value of the first column of the key, which they all have: rows of it
///                  that stand there already go
///   has_row(product)  whether there is any
///   t_tai_ns(product)  when it was, as in the main table: only rows of the latest product stay
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

/// Place of a column of `Table`; a name that it does not have does not compile.
template <class Table>
struct ColumnOf {
  int index = 0;

  // Not explicit: a name stands for its column.
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
