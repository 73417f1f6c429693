/// @file
/// The write-ahead log carried into the database file beside the writing of it.

#pragma once

#include <SQLiteCpp/Database.h>

#include <atomic>
#include <stop_token>
#include <thread>

struct sqlite3;

namespace spindrift {

/// SQLite's own checkpoint holds up the commit that it comes after, for as long as all pages of the
/// log take to write and sync: a fix would wait for it. Here a thread with a connection of its own
/// does the bulk while commits go on, in rounds that grow shorter, and the writer no more than what
/// was committed during the last of them, so that the log begins anew.
///
/// Before 3.51.3 SQLite damages a file when one connection begins the log anew while another starts
/// a checkpoint (https://www.sqlite.org/wal.html#walresetbug). Every round here starts while frames
/// are in the log that no checkpoint has carried over, and until one has, no log begins anew.
class Checkpointer {
 public:
  /// @param writer The connection that commits, which no one else checkpoints; it outlives this.
  /// @throws SQLite::Exception
  explicit Checkpointer(SQLite::Database& writer);
  ~Checkpointer();
  Checkpointer(const Checkpointer&) = delete;
  Checkpointer& operator=(const Checkpointer&) = delete;
  Checkpointer(Checkpointer&&) = delete;
  Checkpointer& operator=(Checkpointer&&) = delete;

 private:
  enum class State { Idle, Asked, Done, Stopped };

  static int on_commit(void* self, sqlite3* writer, const char* schema, int log_frames);
  void note_commit(sqlite3* writer, int log_frames);
  void run();
  /// @return False when the disk failed to sync.
  bool carry_over();

  SQLite::Database& writer_;
  SQLite::Database own_;
  int due_frames_;  // Of the writer's thread: how long the log may grow.
  std::atomic<int> log_frames_ = 0;
  std::atomic<State> state_ = State::Idle;
  std::jthread thread_;  // Last: it uses the others.
};

}  // namespace spindrift
