#include "services/archive/write_lock.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>

#include "pipelines/core/shown.h"

namespace spindrift {
namespace {

constexpr int kNoLockFile = -1;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

std::string this_process() {
  std::string command = text_of("/proc/self/cmdline");
  if (!command.empty()) {
    command.pop_back();
  }
  std::replace(command.begin(), command.end(), '\0', ' ');
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return fmt::format("pid {} ({}) on {} since {:%FT%TZ}", getpid(), shown(command), host.data(),
                     fmt::gmtime(std::chrono::system_clock::now()));
}

Unexpected failure(const std::filesystem::path& lock, int error) {
  // A place where no file can be created is no place for an archive.
  const bool no_place = error == ENOENT || error == EACCES || error == EROFS || error == EPERM;
  return Unexpected{{no_place ? ErrorCode::InvalidConfiguration : ErrorCode::Unavailable,
                     fmt::format("cannot lock {}: {}", shown(lock.string()),
                                 std::system_category().message(error))}};
}

bool write_text(int file, const std::string& text) {
  return ftruncate(file, 0) == 0 &&
         pwrite(file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
}

}  // namespace

Expected<WriteLock> WriteLock::acquire(const std::filesystem::path& archive) {
  const std::filesystem::path path = archive.string() + ".lock";
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file == kNoLockFile) {
    return failure(path, errno);
  }
  WriteLock lock{file};
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    if (error != EWOULDBLOCK) {
      return failure(path, error);
    }
    return Unexpected{
        {ErrorCode::Unavailable, fmt::format("archive {} is being written by {}",
                                             shown(archive.string()), shown(text_of(path)))}};
  }
  if (!write_text(file, this_process())) {
    return failure(path, errno);
  }
  return lock;
}

WriteLock::WriteLock(WriteLock&& other) noexcept : file_{std::exchange(other.file_, kNoLockFile)} {}

// The lock file is not removed: removing it could take the name from under the next holder.
WriteLock::~WriteLock() {
  if (file_ != kNoLockFile) {
    close(file_);
  }
}

}  // namespace spindrift
