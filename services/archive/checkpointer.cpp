#include "services/archive/checkpointer.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

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

constexpr int kPages = 16;

struct Pace {
  bool kept = false;
  int written_pages = 0;
};

Pace& of_this_thread() {
  thread_local Pace pace;
  return pace;
}

// Errors are ignored here, because the sync after all pages reports them.
void bring_to_disk(int file) {
  constexpr unsigned kThoseWrittenSoFar =
      SYNC_FILE_RANGE_WAIT_BEFORE | SYNC_FILE_RANGE_WRITE | SYNC_FILE_RANGE_WAIT_AFTER;
  static_cast<void>(sync_file_range(file, 0, 0, kThoseWrittenSoFar));
}

ssize_t write_page(int file, const void* bytes, size_t count, off64_t offset) {
  const ssize_t written = pwrite64(file, bytes, count, offset);
  Pace& pace = of_this_thread();
  if (pace.kept && written >= 0 && ++pace.written_pages % kPages == 0) {
    bring_to_disk(file);
  }
  return written;
}

// Replaces SQLite's call of pwrite64, once per process.
bool take_place() {
  sqlite3_vfs* const vfs = sqlite3_vfs_find(nullptr);
  return vfs->xSetSystemCall(vfs, "pwrite64", reinterpret_cast<sqlite3_syscall_ptr>(&write_page)) ==
         SQLITE_OK;
}

/// While one of these exists in a thread, the pages that it writes go to the disk as they are
/// written. SQLite alone writes all pages of a checkpoint into the system's cache and then syncs
/// them at once, so that a commit's sync meanwhile waits for all; here it waits for a few.
class PacedWrites {
 public:
  PacedWrites() {
    static const bool taken = take_place();
    of_this_thread().kept = taken;
  }
  ~PacedWrites() { of_this_thread().kept = false; }
  PacedWrites(const PacedWrites&) = delete;
  PacedWrites& operator=(const PacedWrites&) = delete;
  PacedWrites(PacedWrites&&) = delete;
  PacedWrites& operator=(PacedWrites&&) = delete;
};

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
