#include "services/archive/checkpointer.h"

#include <sqlite3.h>

namespace spindrift {
namespace {

constexpr int kLongLog_pages = 4096;

// What keeps one from succeeding, a reader or the disk, is met again by the next; and the commits,
// which tell, meet the disk themselves.
void checkpoint(sqlite3* database) {
  static_cast<void>(
      sqlite3_wal_checkpoint_v2(database, "main", SQLITE_CHECKPOINT_PASSIVE, nullptr, nullptr));
}

}  // namespace

Checkpointer::Checkpointer(SQLite::Database& writer)
    : writer_{writer}, own_{writer.getFilename(), SQLite::OPEN_READWRITE} {
  // A connection has no log before it has read; without one a checkpoint does nothing.
  own_.execAndGet("SELECT count(*) FROM sqlite_schema");
  thread_ = std::jthread{[this](const std::stop_token& stop) { run(stop); }};
  // In place of SQLite's automatic checkpoint.
  sqlite3_wal_hook(writer_.getHandle(), &Checkpointer::on_commit, this);
}

Checkpointer::~Checkpointer() { sqlite3_wal_hook(writer_.getHandle(), nullptr, nullptr); }

// On the writer's thread.
int Checkpointer::on_commit(void* self, sqlite3* writer, const char* /*schema*/, int log_pages) {
  auto& checkpointer = *static_cast<Checkpointer*>(self);
  const State state = checkpointer.state_;
  if (state == State::Done) {
    checkpoint(writer);
    checkpointer.state_ = State::Idle;
  } else if (state == State::Idle && log_pages >= kLongLog_pages) {
    {
      const std::lock_guard lock{checkpointer.mutex_};
      checkpointer.state_ = State::Asked;
    }
    checkpointer.asked_.notify_one();
  }
  return SQLITE_OK;
}

void Checkpointer::run(const std::stop_token& stop) {
  std::unique_lock lock{mutex_};
  while (asked_.wait(lock, stop, [this] { return state_ == State::Asked; })) {
    lock.unlock();
    checkpoint(own_.getHandle());
    state_ = State::Done;
    lock.lock();
  }
}

}  // namespace spindrift
