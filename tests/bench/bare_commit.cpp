/// @file
/// Reference for the commit time of the archive: one small row a transaction, synchronous = FULL.
///
///     bare_commit NEW.db COUNT
///
/// Prints median and 99th percentile in microseconds.

#include <sqlite3.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

namespace {

using std::chrono::steady_clock;

void check(bool good, sqlite3* database) {
  if (!good) {
    std::fprintf(stderr, "bare_commit: %s\n", sqlite3_errmsg(database));
    std::exit(1);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::span<char*> arguments{argv, static_cast<std::size_t>(argc)};
  const long count = arguments.size() == 3 ? std::strtol(arguments[2], nullptr, 10) : 0;
  if (count < 1) {
    std::fprintf(stderr, "usage: bare_commit NEW.db COUNT\n");
    return 2;
  }
  sqlite3* database = nullptr;
  check(sqlite3_open(arguments[1], &database) == SQLITE_OK, database);
  check(sqlite3_exec(database,
                     "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL;"
                     "CREATE TABLE row (id INTEGER PRIMARY KEY, value REAL NOT NULL) STRICT",
                     nullptr, nullptr, nullptr) == SQLITE_OK,
        database);
  sqlite3_stmt* statement = nullptr;
  check(sqlite3_prepare_v2(database, "INSERT INTO row (value) VALUES (?)", -1, &statement,
                           nullptr) == SQLITE_OK,
        database);
  std::vector<double> taken_us;
  for (long i = 0; i < count; ++i) {
    const auto start = steady_clock::now();
    sqlite3_bind_double(statement, 1, static_cast<double>(i));
    check(sqlite3_step(statement) == SQLITE_DONE, database);
    sqlite3_reset(statement);
    const std::chrono::duration<double, std::micro> taken = steady_clock::now() - start;
    taken_us.push_back(taken.count());
  }
  std::sort(taken_us.begin(), taken_us.end());
  std::printf("%.0f %.0f\n", taken_us[taken_us.size() / 2], taken_us[taken_us.size() * 99 / 100]);
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return 0;
}
