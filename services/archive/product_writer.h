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

  /// In place of one with its key.
  /// @param announced_utc Of products that are announced, when; empty: they are not for now.
  void insert(const std::string& run_id, const std::string& spacecraft_id,
              const std::optional<std::string>& announced_utc, const Product& product);

  /// Those of a run from a time on, but those that stay (kStays). A product without a time has that
  /// of its revolution, which those tables tell that have both.
  void withdraw(const std::string& run_id, TaiTime from);

 private:
  struct Kinds;
  SQLite::Database& database_;
  std::unique_ptr<Kinds> kinds_;
};

}  // namespace spindrift
