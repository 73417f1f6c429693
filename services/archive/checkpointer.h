/// @file
/// The write-ahead log carried into the database file beside the writing of it.

#pragma once

#include <SQLiteCpp/Database.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

struct sqlite3;

namespace spindrift {

/// SQLite's own checkpoint holds up the commit that it comes after, for as long as all pages of the
/// log take to write and sync: a fix would wait for it. Here a thread with a connection of its own
/// does the bulk while commits go on, and the writer no more than what was committed meanwhile, so
/// that the log begins anew.
class Checkpointer {
 public:
  /// @param writer The connection that commits; it outlives this one.
  /// @throws SQLite::Exception
  explicit Checkpointer(SQLite::Database& writer);
  ~Checkpointer();
  Checkpointer(const Checkpointer&) = delete;
  Checkpointer& operator=(const Checkpointer&) = delete;
  Checkpointer(Checkpointer&&) = delete;
  Checkpointer& operator=(Checkpointer&&) = delete;

 private:
  enum class State { Idle, Asked, Done };

  static int on_commit(void* self, sqlite3* writer, const char* schema, int log_pages);
  void run(const std::stop_token& stop);

  SQLite::Database& writer_;
  SQLite::Database own_;
  std::atomic<State> state_ = State::Idle;
  std::mutex mutex_;
  std::condition_variable_any asked_;
  std::jthread thread_;  // Last: it uses the others.
};

}  // namespace spindrift
