/// @file
/// Products to rows of SQL, as services/products says: the one place that writes them.

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

/// The prepared statements of one connection. All of it throws SQLite::Exception.
class ProductWriter {
 public:
  /// `database` must outlive it.
  explicit ProductWriter(SQLite::Database& database);
  ~ProductWriter();
  ProductWriter(const ProductWriter&) = delete;
  ProductWriter& operator=(const ProductWriter&) = delete;
  ProductWriter(ProductWriter&&) = delete;
  ProductWriter& operator=(ProductWriter&&) = delete;

  /// Whether a row of it has announced_utc.
  static bool says_when_announced(const Product& product);

  /// In place of one with its key.
  /// @param announced_utc Where it says that; empty: it is not announced for now.
  void insert(const RunOfProducts& run, const std::optional<std::string>& announced_utc,
              const Product& product);

  /// Those of a run from a time on, but those that stay (kStays). A product without a time has that
  /// of its revolution, which those tables tell that have both.
  void withdraw(const std::string& run_id, TaiTime from);

 private:
  struct Kinds;
  SQLite::Database& database_;
  std::unique_ptr<Kinds> kinds_;
};

}  // namespace spindrift
