/// @file
/// Reference for the archive's writer: copies the rows of an archive into another of the same
/// schema with one prepared statement for each table, in one transaction.
///
///     bare_insert FROM.db TO.db [TABLE...]
///
/// Prints the number of rows and the seconds without those of reading.

#include <sqlite3.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

namespace {

using std::chrono::steady_clock;

// Number of values held in memory at a time.
constexpr std::size_t kChunkValues = 1'000'000;

void check(bool good, sqlite3* database) {
  if (!good) {
    std::fprintf(stderr, "bare_insert: %s\n", sqlite3_errmsg(database));
    std::exit(1);
  }
}

void execute(sqlite3* database, const std::string& sql) {
  check(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK, database);
}

sqlite3_stmt* prepare(sqlite3* database, const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  check(sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr) == SQLITE_OK, database);
  return statement;
}

std::vector<std::string> texts(sqlite3* database, const std::string& sql) {
  std::vector<std::string> found;
  sqlite3_stmt* const statement = prepare(database, sql);
  while (sqlite3_step(statement) == SQLITE_ROW) {
    found.emplace_back(reinterpret_cast<const char*>(sqlite3_column_text(statement, 0)));
  }
  sqlite3_finalize(statement);
  return found;
}

struct Copied {
  long rows = 0;
  double seconds = 0.0;
};

/// Inserts `values`, `columns` of them for each row, and frees them.
double insert(sqlite3* to, sqlite3_stmt* statement, std::vector<sqlite3_value*>& values,
              int columns) {
  const auto start = steady_clock::now();
  for (std::size_t at = 0; at < values.size(); at += static_cast<std::size_t>(columns)) {
    for (int column = 0; column < columns; ++column) {
      sqlite3_bind_value(statement, column + 1, values[at + static_cast<std::size_t>(column)]);
    }
    check(sqlite3_step(statement) == SQLITE_DONE, to);
    sqlite3_reset(statement);
  }
  const std::chrono::duration<double> taken = steady_clock::now() - start;
  for (sqlite3_value* value : values) {
    sqlite3_value_free(value);
  }
  values.clear();
  return taken.count();
}

Copied copy(sqlite3* from, sqlite3* to, const std::string& table) {
  sqlite3_stmt* const select = prepare(from, "SELECT * FROM " + table);
  const int columns = sqlite3_column_count(select);
  std::string places = "?";
  for (int column = 1; column < columns; ++column) {
    places += ", ?";
  }
  sqlite3_stmt* const statement = prepare(to, "INSERT INTO " + table + " VALUES (" + places + ")");
  Copied copied;
  std::vector<sqlite3_value*> values;
  while (sqlite3_step(select) == SQLITE_ROW) {
    for (int column = 0; column < columns; ++column) {
      values.push_back(sqlite3_value_dup(sqlite3_column_value(select, column)));
    }
    ++copied.rows;
    if (values.size() >= kChunkValues) {
      copied.seconds += insert(to, statement, values, columns);
    }
  }
  copied.seconds += insert(to, statement, values, columns);
  sqlite3_finalize(select);
  sqlite3_finalize(statement);
  return copied;
}

}  // namespace

int main(int argc, char** argv) {
  const std::span<char*> arguments{argv, static_cast<std::size_t>(argc)};
  if (arguments.size() < 3) {
    std::fprintf(stderr, "usage: bare_insert FROM.db TO.db [TABLE...]\n");
    return 2;
  }
  sqlite3* from = nullptr;
  sqlite3* to = nullptr;
  check(sqlite3_open_v2(arguments[1], &from, SQLITE_OPEN_READONLY, nullptr) == SQLITE_OK, from);
  check(sqlite3_open(arguments[2], &to) == SQLITE_OK, to);
  execute(to, "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL");
  const std::string of_the_schema =
      "FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite_%'";
  for (const std::string& sql : texts(from, "SELECT sql " + of_the_schema)) {
    execute(to, sql);
  }
  std::vector<std::string> tables(arguments.begin() + 3, arguments.end());
  if (tables.empty()) {
    tables = texts(from, "SELECT name " + of_the_schema);
  }

  Copied all;
  execute(to, "BEGIN IMMEDIATE");
  for (const std::string& table : tables) {
    const Copied copied = copy(from, to, table);
    all.rows += copied.rows;
    all.seconds += copied.seconds;
  }
  const auto start = steady_clock::now();
  execute(to, "COMMIT");
  all.seconds += std::chrono::duration<double>(steady_clock::now() - start).count();
  std::printf("%ld rows %.3f s\n", all.rows, all.seconds);
  sqlite3_close(from);
  sqlite3_close(to);
  return 0;
}
