/// @file
/// Writes products as rows of SQL, as services/products describes them.

#pragma once

#include <SQLiteCpp/Database.h>

#include <memory>
#include <optional>
#include <string>

#include "pipelines/time/tai_time.h"
#include "services/products/products.h"

namespace spindrift {

struct RunOfProducts {
  const std::string& run_id;
  const std::string& spacecraft_id;
  bool stores_residuals;
};

/// Holds the prepared statements of one connection. All functions throw SQLite::Exception.
class ProductWriter {
 public:
  /// `database` must outlive it.
  explicit ProductWriter(SQLite::Database& database);
  ~ProductWriter();
  ProductWriter(const ProductWriter&) = delete;
  ProductWriter& operator=(const ProductWriter&) = delete;
  ProductWriter(ProductWriter&&) = delete;
  ProductWriter& operator=(ProductWriter&&) = delete;

  /// Returns whether the product has a table with the column announced_utc.
  static bool says_when_announced(const Product& product);

  /// Stores a product, replacing one with the same key.
  /// @param announced_utc Value of the column announced_utc, if any; empty: not announced so far.
  void insert(const RunOfProducts& run, const std::optional<std::string>& announced_utc,
              const Product& product);

  /// Deletes the products of a run from a time on, except kinds that stay (kStays). A product
  /// without a time is deleted by its revolution, whose time comes from the tables that have both.
  void withdraw(const std::string& run_id, TaiTime from);

 private:
  struct Kinds;
  SQLite::Database& database_;
  std::unique_ptr<Kinds> kinds_;
};

}  // namespace spindrift
