#include "services/archive/archive_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

#include "services/archive/connection.h"

namespace spindrift {
namespace {

constexpr int kNoFile = -1;

std::string reason(int error) { return std::system_category().message(error); }

Unexpected unavailable(const std::filesystem::path& path, const std::string& what) {
  return Unexpected{{ErrorCode::Unavailable, fmt::format("archive {}: {}", path.string(), what)}};
}

/// Finds the holder in /proc/locks: NUMBER: FLOCK ADVISORY WRITE PID DEVICE:INODE START END.
std::string holder_of(ino_t inode) {
  std::ifstream locks{"/proc/locks"};
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words{line};
    std::string number;
    std::string type;
    std::string skipped;
    std::string pid;
    std::string file;
    words >> number >> type >> skipped >> skipped >> pid >> file;
    if (type == "FLOCK" && file.ends_with(fmt::format(":{}", inode))) {
      return "pid " + pid;
    }
  }
  return "another process";
}

Expected<struct stat> status_of(int file, const std::filesystem::path& path) {
  struct stat status {};
  if (fstat(file, &status) != 0) {
    return unavailable(path, reason(errno));
  }
  return status;
}

}  // namespace

Expected<ArchiveFile> ArchiveFile::hold(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CREAT | O_CLOEXEC, 0644);
  if (file == kNoFile) {
    return unavailable(path, reason(errno));
  }
  const auto status = status_of(file, path);
  if (!status) {
    return Unexpected{status.error()};
  }
  // The descriptor stays open even without the lock: if this process has the file open in SQLite,
  // closing it would drop SQLite's locks.
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    return errno == EWOULDBLOCK
               ? unavailable(path, fmt::format("its file is being written under another name, a "
                                               "hard link or one that it had, by {}",
                                               holder_of(status->st_ino)))
               : unavailable(path, "cannot be locked: " + reason(errno));
  }
  return ArchiveFile{file, path, Identity{status->st_dev, status->st_ino}};
}

ArchiveFile::ArchiveFile(int file, const std::filesystem::path& path, const Identity& identity)
    : file_{file}, names_{{{path, identity}, {log_of(path), {}}, {path.string() + "-shm", {}}}} {}

ArchiveFile::ArchiveFile(ArchiveFile&& other) noexcept
    : file_{std::exchange(other.file_, kNoFile)},
      names_{std::move(other.names_)},
      least_bytes_{other.least_bytes_},
      most_bytes_{other.most_bytes_},
      damage_{std::move(other.damage_)} {}

ArchiveFile::~ArchiveFile() {
  if (file_ != kNoFile) {
    close(file_);
  }
}

std::optional<ArchiveFile::Identity> ArchiveFile::identity_at(const std::filesystem::path& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? std::optional{Identity{status.st_dev, status.st_ino}}
                                          : std::nullopt;
}

void ArchiveFile::note_log() {
  for (Name& name : names_) {
    name.file = name.file ? name.file : identity_at(name.path);
  }
}

Expected<void> ArchiveFile::in_place() const {
  for (const auto& [path, file] : names_) {
    const auto now = identity_at(path);
    if (now != file) {
      return unavailable(names_[0].path,
                         fmt::format("{} was {} while it was written", path.string(),
                                     now ? "replaced by another file" : "deleted or moved away"));
    }
  }
  return {};
}

void ArchiveFile::note_bytes(std::int64_t sqlite_bytes) {
  least_bytes_ = std::min(least_bytes_, sqlite_bytes);
  most_bytes_ = std::max(most_bytes_, sqlite_bytes);
}

Expected<void> ArchiveFile::undamaged(const std::function<std::int64_t()>& sqlite_bytes) {
  if (damage_) {
    return Unexpected{*damage_};
  }
  const std::filesystem::path& path = names_[0].path;
  const auto status = status_of(file_, path);
  if (!status) {
    return Unexpected{status.error()};
  }
  std::string header(kHeaderBytes, '\0');
  const bool is_ours =
      pread(file_, header.data(), header.size(), 0) == kHeaderBytes && is_header_of_archive(header);
  // Asked after the file, so that a checkpoint by another program between the two is no damage.
  const std::int64_t now_bytes = sqlite_bytes();
  note_bytes(now_bytes);
  if (is_ours && status->st_size >= least_bytes_ && status->st_size <= most_bytes_) {
    least_bytes_ = std::min(status->st_size, now_bytes);
    return {};
  }
  damage_ = Error{
      ErrorCode::Unavailable,
      fmt::format("archive {}: its file was truncated or overwritten while it was written ({}, {} "
                  "bytes now, {} to {} before): what was stored is lost or doubtful. Stop the "
                  "program, move the file and {} away together, of which the command .recover of "
                  "sqlite3 reads what is left, and start again: front-ends send again what they "
                  "keep",
                  path.string(), is_ours ? "an archive" : "no archive", status->st_size,
                  least_bytes_, most_bytes_, names_[1].path.string())};
  return Unexpected{*damage_};
}

std::optional<std::filesystem::path> ArchiveFile::in_the_way() const {
  const auto& [archive, log, index] = names_;
  std::error_code unknown;
  if (std::filesystem::exists(std::filesystem::symlink_status(archive.path, unknown)) &&
      identity_at(archive.path) != archive.file) {
    return archive.path;
  }
  const std::uintmax_t log_bytes = std::filesystem::file_size(log.path, unknown);
  return !unknown && log_bytes > 0 && identity_at(log.path) != log.file ? std::optional{log.path}
                                                                        : std::nullopt;
}

void ArchiveFile::take_log_away() const {
  for (const Name& name : {names_[1], names_[2]}) {
    if (identity_at(name.path) == name.file) {
      unlink(name.path.c_str());
    }
  }
}

Expected<void> ArchiveFile::give_way_to(const std::filesystem::path& copy) const {
  const auto& [path, file] = names_[0];
  const auto status = status_of(file_, path);
  if (!status || chmod(copy.c_str(), status->st_mode) != 0 ||
      renameat2(AT_FDCWD, copy.c_str(), AT_FDCWD, path.c_str(),
                identity_at(path) == file ? 0 : RENAME_NOREPLACE) != 0) {
    return unavailable(path, fmt::format("{} cannot take its place: {}", copy.string(),
                                         status ? reason(errno) : status.error().message));
  }
  unlink(names_[1].path.c_str());
  unlink(names_[2].path.c_str());
  return {};
}

}  // namespace spindrift
