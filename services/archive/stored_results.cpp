#include "services/archive/stored_results.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <variant>

#include "services/archive/connection.h"

namespace spindrift {
namespace {

struct Identity {
  std::pair<std::size_t, std::string> instance;
  std::int64_t number;
  bool is_settled;
};

/// Returns the identity of a product; empty when it is not announced.
std::optional<Identity> identity_of(const Product& product) {
  return std::visit(
      [&]<class Kind>(const Kind& value) -> std::optional<Identity> {
        if constexpr (AnnouncedProduct<Kind>) {
          if (ProductKind<Kind>::is_announced(value)) {
            return Identity{
                .instance = {product.index(), std::string{ProductKind<Kind>::instance(value)}},
                .number = ProductKind<Kind>::number(value),
                .is_settled = ProductKind<Kind>::is_settled(value)};
          }
        }
        return std::nullopt;
      },
      product);
}

/// A row of a query with the columns of `Table` in their order.
template <class Table>
class StoredRow {
 public:
  explicit StoredRow(SQLite::Statement& row) : row_{row} {}
  bool has(ColumnOf<Table> column) const { return !row_.getColumn(column.index).isNull(); }
  double real(ColumnOf<Table> column) const { return row_.getColumn(column.index).getDouble(); }
  std::int64_t integer(ColumnOf<Table> column) const {
    return row_.getColumn(column.index).getInt64();
  }
  std::string_view text(ColumnOf<Table> column) const {
    return row_.getColumn(column.index).getText();
  }

 private:
  SQLite::Statement& row_;
};

/// Calls `see` with each row of `Table` of a run that meets `condition`, in order of the key.
template <class Table, class See>
void for_each_stored(const SQLite::Database& database, const std::string& run_id,
                     const std::string& condition, const See& see) {
  const auto columns =
      with_columns<Table>([](const auto&... column) { return std::array{column.name...}; });
  SQLite::Statement row{database, fmt::format("SELECT {} FROM {} WHERE run_id = ?{} ORDER BY {}",
                                              fmt::join(columns, ", "), Table::kName, condition,
                                              fmt::join(Table::kKey, ", "))};
  row.bind(1, run_id);
  while (row.executeStep()) {
    see(StoredRow<Table>{row});
  }
}

template <class Kind>
void read(const SQLite::Database& database, const std::string& run_id, StoredResults& stored) {
  using Table = MainTable<Kind>;
  std::string condition;
  if constexpr (requires { Table::kCondition; }) {
    condition = fmt::format(" AND {}", Table::kCondition);
  }
  for_each_stored<Table>(database, run_id, condition, [&](const StoredRow<Table>& row) {
    if constexpr (requires { typename ProductKind<Kind>::Parts; }) {
      using Parts = typename ProductKind<Kind>::Parts;
      constexpr std::string_view kGroup = Parts::kKey.front();
      const auto group = fmt::format(" AND {} = '{}'", kGroup, row.text(kGroup.data()));
      stored.add(ProductKind<Kind>::from_row(
          row, [&](const auto& see) { for_each_stored<Parts>(database, run_id, group, see); }));
    } else {
      stored.add(ProductKind<Kind>::from_row(row));
    }
  });
}

bool has(const std::vector<std::int64_t>& sorted, std::int64_t number) {
  return std::binary_search(sorted.begin(), sorted.end(), number);
}

}  // namespace

std::vector<Product> StoredResults::in_force() const {
  std::vector<Product> products;
  products.reserve(given_.size());
  for (const auto& [instance, given] : given_) {
    products.push_back(given.last);
  }
  return products;
}

bool StoredResults::hold(const Product& product) const {
  const auto identity = identity_of(product);
  const auto given = identity ? given_.find(identity->instance) : given_.end();
  return given != given_.end() &&
         (has(given->second.settled, identity->number) ||
          (!identity->is_settled && has(given->second.open, identity->number)));
}

void StoredResults::add(Product product) {
  if (const auto identity = identity_of(product)) {
    Given& given = given_.try_emplace(identity->instance, Given{.last = product}).first->second;
    (identity->is_settled ? given.settled : given.open).push_back(identity->number);
    given.last = std::move(product);
  }
}

Expected<StoredResults> find_stored_results(const std::filesystem::path& archive,
                                            const std::string& run_id) {
  return read_archive(archive, [&](SQLite::Database& database) {
    StoredResults stored;
    for_each_product_kind([&]<class Kind>() {
      if constexpr (AnnouncedProduct<Kind>) {
        read<Kind>(database, run_id, stored);
      }
    });
    return stored;
  });
}

}  // namespace spindrift
