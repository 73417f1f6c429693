#include "services/archive/paced_writes.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

namespace spindrift {
namespace {

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

}  // namespace

PacedWrites::PacedWrites() {
  static const bool taken = take_place();
  of_this_thread().kept = taken;
}

PacedWrites::~PacedWrites() { of_this_thread().kept = false; }

}  // namespace spindrift
