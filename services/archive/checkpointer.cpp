#include "services/archive/checkpointer.h"

#include <sqlite3.h>

#include "services/archive/paced_writes.h"
#include "services/base/contained.h"

namespace spindrift {
namespace {

// A long log saves work, because a page is written once however often it is in the log.
constexpr int kLongLog_frames = 32768;
// Few enough frames for the writer to carry over in about the time of a few commits.
constexpr int kFewFrames = 48;
constexpr int kMostRounds = 20;
// When the log grows faster than it is carried over, commits wait above this length.
constexpr int kTooLong_frames = 3 * kLongLog_frames;

// Returns how many frames of the log are in the file now. Errors are ignored: a reader or a disk
// failure that stops a checkpoint stops the next one too, and a disk failure also stops the
// commits, which report it.
int checkpoint(sqlite3* database) {
  int log_frames = 0;
  int carried_frames = 0;
  static_cast<void>(sqlite3_wal_checkpoint_v2(database, "main", SQLITE_CHECKPOINT_PASSIVE,
                                              &log_frames, &carried_frames));
  return carried_frames;
}

// Syncs the file. SQLite syncs only in the checkpoint that reaches the end of the log, which is the
// writer's; without this the writer would wait for the sync of all pages.
bool sync(sqlite3* database) {
  sqlite3_file* file = nullptr;
  sqlite3_file_control(database, "main", SQLITE_FCNTL_FILE_POINTER, &file);
  return file->pMethods->xSync(file, SQLITE_SYNC_NORMAL | SQLITE_SYNC_DATAONLY) == SQLITE_OK;
}

}  // namespace

Checkpointer::Checkpointer(SQLite::Database& writer)
    : writer_{writer},
      own_{writer.getFilename(), SQLite::OPEN_READWRITE},
      due_frames_{kLongLog_frames} {
  // A connection has no log before its first read, and without one a checkpoint does nothing.
  own_.execAndGet("SELECT count(*) FROM sqlite_schema");
  thread_ = std::jthread{[this] {
    if (!contained("carrying over", [this] { run(); })) {
      state_ = State::Stopped;
      state_.notify_one();
    }
  }};
  // Replaces SQLite's automatic checkpoint.
  sqlite3_wal_hook(writer_.getHandle(), &Checkpointer::on_commit, this);
}

Checkpointer::~Checkpointer() {
  sqlite3_wal_hook(writer_.getHandle(), nullptr, nullptr);
  state_ = State::Stopped;
  state_.notify_one();
}

int Checkpointer::on_commit(void* self, sqlite3* writer, const char* /*schema*/, int log_frames) {
  static_cast<Checkpointer*>(self)->note_commit(writer, log_frames);
  return SQLITE_OK;
}

void Checkpointer::note_commit(sqlite3* writer, int log_frames) {
  log_frames_ = log_frames;
  const State state = state_;
  if (state == State::Done) {
    // When a reader still needs the log, the log is not restarted and may grow by as much again.
    const bool all = checkpoint(writer) == log_frames;
    due_frames_ = (all ? 0 : log_frames) + kLongLog_frames;
    state_ = State::Idle;
  } else if (state == State::Idle && log_frames >= due_frames_) {
    state_ = State::Asked;
    state_.notify_one();
  } else if (log_frames >= due_frames_ + kTooLong_frames) {
    state_.wait(State::Asked);
  }
}

void Checkpointer::run() {
  const PacedWrites a_few_pages_at_a_time;
  for (State state = state_; state != State::Stopped; state = state_) {
    if (state != State::Asked) {
      state_.wait(state);
      continue;
    }
    if (carry_over()) {
      state_.compare_exchange_strong(state, State::Done);
    } else {
      // It is unknown which pages are lost. The log has them all, so it is never restarted.
      state_ = State::Stopped;
    }
    state_.notify_one();
  }
}

bool Checkpointer::carry_over() {
  int carried_frames = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const int before = carried_frames;
    carried_frames = checkpoint(own_.getHandle());
    if (!sync(own_.getHandle())) {
      return false;
    }
    if (carried_frames <= before || log_frames_ - carried_frames <= kFewFrames) {
      break;
    }
  }
  return true;
}

}  // namespace spindrift
