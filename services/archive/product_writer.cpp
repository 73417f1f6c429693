#include "services/archive/product_writer.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include "services/archive/bind.h"

namespace spindrift {
namespace {

template <class Table>
constexpr bool kOfSpacecraft = requires {
  Table::kOfSpacecraft;
};
template <class Table>
constexpr bool kSaysWhenAnnounced = requires {
  Table::kSaysWhenAnnounced;
};
template <class Table>
constexpr bool kOfResiduals = requires {
  Table::kOfResiduals;
};
template <class Table>
constexpr bool kOfLatest = requires {
  &Table::t_tai_ns;
};
template <class Table>
constexpr bool kHasMany = requires {
  &Table::rows;
};
template <class Kind>
constexpr bool kStays = requires {
  ProductKind<Kind>::kStays;
};
template <class Table>
constexpr bool kHasTime = has_column<Table>("t_tai_ns");

template <class Table>
bool is_of_key(std::string_view column) {
  return std::find(Table::kKey.begin(), Table::kKey.end(), column) != Table::kKey.end();
}

template <class Table>
std::string insertion() {
  std::string names = kOfSpacecraft<Table> ? "run_id, spacecraft_id" : "run_id";
  std::string values = kOfSpacecraft<Table> ? "?, ?" : "?";
  std::string changes;
  const auto add = [&](std::string_view column) {
    // Column names are quoted because "limit" is a keyword of SQL.
    names += fmt::format(R"(, "{}")", column);
    values += ", ?";
    if (!is_of_key<Table>(column)) {
      changes +=
          fmt::format(R"({}"{}" = excluded."{}")", changes.empty() ? "" : ", ", column, column);
    }
  };
  if constexpr (kSaysWhenAnnounced<Table>) {
    names += ", announced_utc";  // A replacing product keeps the first value.
    values += ", ?";
  }
  with_columns<Table>([&](const auto&... column) { (add(column.name), ...); });
  std::string sql = fmt::format("INSERT INTO {} ({}) VALUES ({}) ON CONFLICT DO UPDATE SET {}",
                                Table::kName, names, values, changes);
  if constexpr (requires { Table::kReplaces; }) {
    sql += fmt::format(" WHERE {}", Table::kReplaces);
  }
  return sql;
}

/// Writes the rows that one kind of product has in one table.
template <class Kind, class Table>
class TableWriter {
 public:
  explicit TableWriter(SQLite::Database& database) : insert_{database, insertion<Table>()} {
    if constexpr (kHasMany<Table>) {
      gone_.emplace(database, fmt::format("DELETE FROM {} WHERE run_id = ? AND {} = ?",
                                          Table::kName, Table::kKey.front()));
    }
    if constexpr (kOfLatest<Table>) {
      later_.emplace(database, fmt::format("SELECT 1 FROM {} WHERE run_id = ? AND t_tai_ns > ?",
                                           MainTable<Kind>::kName));
    }
  }

  void write(const RunOfProducts& run, const std::optional<std::string>& announced_utc,
             const Kind& product) {
    if (is_outdated(run.run_id, product) || (kOfResiduals<Table> && !run.stores_residuals)) {
      return;
    }
    if constexpr (kHasMany<Table>) {
      execute(*gone_, run.run_id, Table::group(product));
    }
    for_each_row<Table>(product, [&](const auto& row) {
      with_columns<Table>([&](const auto&... column) {
        if constexpr (kOfSpacecraft<Table>) {
          execute(insert_, run.run_id, run.spacecraft_id, column.of(row)...);
        } else if constexpr (kSaysWhenAnnounced<Table>) {
          execute(insert_, run.run_id, announced_utc, column.of(row)...);
        } else {
          execute(insert_, run.run_id, column.of(row)...);
        }
      });
    });
  }

 private:
  bool is_outdated(const std::string& run_id, const Kind& product) {
    if constexpr (kOfLatest<Table>) {
      later_->tryReset();
      bind(*later_, 1, run_id);
      bind(*later_, 2, Table::t_tai_ns(product));
      const bool is_there = later_->executeStep();
      later_->reset();
      return is_there;
    } else {
      return false;
    }
  }

  SQLite::Statement insert_;
  std::optional<SQLite::Statement> gone_;
  std::optional<SQLite::Statement> later_;
};

template <class Kind, class Tables = typename ProductKind<Kind>::Tables>
class KindWriter;
template <class Kind, class... Table>
class KindWriter<Kind, std::tuple<Table...>> {
 public:
  explicit KindWriter(SQLite::Database& database)
      : tables_{TableWriter<Kind, Table>{database}...} {}

  void write(const RunOfProducts& run, const std::optional<std::string>& announced_utc,
             const Kind& product) {
    if constexpr (requires { ProductKind<Kind>::without_residuals(product); }) {
      if (!run.stores_residuals) {
        write_all(run, announced_utc, ProductKind<Kind>::without_residuals(product));
        return;
      }
    }
    write_all(run, announced_utc, product);
  }

 private:
  void write_all(const RunOfProducts& run, const std::optional<std::string>& announced_utc,
                 const Kind& product) {
    std::apply([&](auto&... table) { (table.write(run, announced_utc, product), ...); }, tables_);
  }

  std::tuple<TableWriter<Kind, Table>...> tables_;
};

template <class Products>
struct KindWriters;
template <class... Kind>
struct KindWriters<std::variant<Kind...>> {
  explicit KindWriters(SQLite::Database& database) : all{KindWriter<Kind>{database}...} {}
  std::tuple<KindWriter<Kind>...> all;
};

template <class Table>
std::string since() {
  std::string sql = fmt::format("FROM {} WHERE run_id = ?1 AND t_tai_ns >= ?2", Table::kName);
  if constexpr (requires { Table::kCondition; }) {
    sql += fmt::format(" AND {}", Table::kCondition);
  }
  return sql;
}

/// Selects the first revolution with any row from time ?2 on. All tables are searched, because a
/// revolution without sun1 appears only with its edges and its fix.
std::string first_revolution() {
  std::string revolutions;
  for_each_product_kind([&]<class Kind>() {
    for_each_table<Kind>([&]<class Table>() {
      if constexpr (has_column<Table>("revolution") && kHasTime<Table>) {
        revolutions += fmt::format("{}SELECT revolution {}",
                                   revolutions.empty() ? "" : " UNION ALL ", since<Table>());
      }
    });
  });
  return fmt::format("(SELECT min(revolution) FROM ({}))", revolutions);
}

template <class Kind, class Table>
std::string withdrawal() {
  if constexpr (kOfLatest<Table>) {
    // All rows are deleted with their product, whatever times they have themselves.
    return fmt::format("DELETE FROM {} WHERE run_id = ?1 AND EXISTS (SELECT 1 {})", Table::kName,
                       since<MainTable<Kind>>());
  } else if constexpr (kHasTime<Table>) {
    return "DELETE " + since<Table>();
  } else {
    static_assert(has_column<Table>("revolution"), "nothing tells when its rows are withdrawn");
    return fmt::format("DELETE FROM {} WHERE run_id = ?1 AND revolution >= {}", Table::kName,
                       first_revolution());
  }
}

}  // namespace

struct ProductWriter::Kinds : KindWriters<Product> {
  using KindWriters::KindWriters;
};

ProductWriter::ProductWriter(SQLite::Database& database)
    : database_{database}, kinds_{std::make_unique<Kinds>(database)} {}

ProductWriter::~ProductWriter() = default;

bool ProductWriter::says_when_announced(const Product& product) {
  return std::visit(
      []<class Kind>(const Kind& /*value*/) {
        bool says = false;
        for_each_table<Kind>([&]<class Table>() { says = says || kSaysWhenAnnounced<Table>; });
        return says;
      },
      product);
}

void ProductWriter::insert(const RunOfProducts& run,
                           const std::optional<std::string>& announced_utc,
                           const Product& product) {
  std::visit(
      [&]<class Kind>(const Kind& value) {
        std::get<KindWriter<Kind>>(kinds_->all).write(run, announced_utc, value);
      },
      product);
}

void ProductWriter::withdraw(const std::string& run_id, TaiTime from) {
  // Rows that depend on other rows are deleted before those.
  for (const bool hangs_on_others : {true, false}) {
    for_each_product_kind([&]<class Kind>() {
      if constexpr (!kStays<Kind>) {
        for_each_table<Kind>([&]<class Table>() {
          constexpr bool kStandsAlone = kHasTime<Table> && std::is_same_v<Table, MainTable<Kind>>;
          if (kStandsAlone != hangs_on_others) {
            SQLite::Statement statement{database_, withdrawal<Kind, Table>()};
            execute(statement, run_id, tai_ns(from));
          }
        });
      }
    });
  }
}

}  // namespace spindrift
