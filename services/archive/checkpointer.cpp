#include "services/archive/checkpointer.h"

#include <sqlite3.h>

#include "services/archive/paced_writes.h"
#include "services/base/contained.h"

namespace spindrift {
namespace {

// A page is written once however often it stands in the log.
constexpr int kLongLog_frames = 32768;
// What the writer carries over in about the time of a few commits.
constexpr int kFewFrames = 48;
constexpr int kMostRounds = 20;
// A log that grows faster than it is carried over has commits wait when it is so much longer.
constexpr int kTooLong_frames = 3 * kLongLog_frames;

// Frames of the log that are in the file now. What keeps a checkpoint from succeeding, a reader or
// the disk, is met again by the next; and the commits, which tell, meet the disk themselves.
int checkpoint(sqlite3* database) {
  int log_frames = 0;
  int carried_frames = 0;
  static_cast<void>(sqlite3_wal_checkpoint_v2(database, "main", SQLITE_CHECKPOINT_PASSIVE,
                                              &log_frames, &carried_frames));
  return carried_frames;
}

// Of those checkpoints SQLite syncs only the one that reaches the end of the log. Were the sync of
// all pages left to that one, the writer would wait for it.
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
  // A connection has no log before it has read; without one a checkpoint does nothing.
  own_.execAndGet("SELECT count(*) FROM sqlite_schema");
  thread_ = std::jthread{[this] {
    if (!contained("carrying over", [this] { run(); })) {
      state_ = State::Stopped;
      state_.notify_one();
    }
  }};
  // In place of SQLite's automatic checkpoint.
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
    // Where a reader still needs the log it does not begin anew, and grows by as much again.
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
      // Which pages are lost is not known: the log, which has them all, is never begun anew.
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
