/// @file
/// Carries the write-ahead log over into the database file while commits go on.

#pragma once

#include <SQLiteCpp/Database.h>

#include <atomic>
#include <stop_token>
#include <thread>

struct sqlite3;

namespace spindrift {

/// Replaces SQLite's own checkpoint, which delays the commit it follows until all pages of the log
/// are written and synced, and with it a fix. Here a thread with its own connection carries over
/// the bulk while commits go on, in ever shorter rounds. The writer then only carries over what was
/// committed during the last round, so that the log can restart.
/// Before 3.51.3 SQLite damages a file when one connection restarts the log while another starts a
/// checkpoint (https://www.sqlite.org/wal.html#walresetbug). Every round here starts while the log
/// has frames that no checkpoint has carried over, and until one has, the log is not restarted.
class Checkpointer {
 public:
  /// @param writer The connection that commits. It outlives this; nobody else may checkpoint it.
  /// @throws SQLite::Exception
  explicit Checkpointer(SQLite::Database& writer);
  ~Checkpointer();
  Checkpointer(const Checkpointer&) = delete;
  Checkpointer& operator=(const Checkpointer&) = delete;
  Checkpointer(Checkpointer&&) = delete;
  Checkpointer& operator=(Checkpointer&&) = delete;

  /// Returns the length of the log after the last commit.
  int log_frames() const { return log_frames_; }

 private:
  enum class State { Idle, Asked, Done, Stopped };

  static int on_commit(void* self, sqlite3* writer, const char* schema, int log_frames);
  void note_commit(sqlite3* writer, int log_frames);
  void run();
  /// @return False when the disk failed to sync.
  bool carry_over();

  SQLite::Database& writer_;
  SQLite::Database own_;
  int due_frames_;  // Length that the log may reach; of the writer's thread.
  std::atomic<int> log_frames_ = 0;
  std::atomic<State> state_ = State::Idle;
  std::jthread thread_;  // Declared last because it uses the other members.
};

}  // namespace spindrift
