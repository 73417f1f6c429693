#include "services/base/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>

#include "pipelines/core/shown.h"

namespace spindrift {
namespace {

/// Returns empty for a regular file of at most `most_bytes`.
std::string why_refused(int file, std::uint64_t most_bytes, struct stat& status) {
  struct statfs system {};
  if (fstat(file, &status) != 0 || fstatfs(file, &system) != 0) {
    return std::generic_category().message(errno);
  }
  if (!S_ISREG(status.st_mode) || system.f_type == PROC_SUPER_MAGIC ||
      system.f_type == SYSFS_MAGIC) {
    return "not a regular file";
  }
  const auto size = static_cast<std::uint64_t>(status.st_size);
  return size <= most_bytes ? std::string{}
                            : fmt::format("{} bytes, must be {} at most", size, most_bytes);
}

}  // namespace

Expected<InputFile> InputFile::open(const std::filesystem::path& path, std::uint64_t most_bytes) {
  const auto unreadable = [&](std::string_view reason) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{}: cannot be read: {}", shown(path.string()), reason)}};
  };
  // Opening a pipe must not block, and a terminal must not become the controlling one.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file < 0) {
    return unreadable(std::generic_category().message(errno));
  }
  struct stat status {};
  if (const std::string reason = why_refused(file, most_bytes, status); !reason.empty()) {
    close(file);
    return unreadable(reason);
  }
  std::FILE* const stream = fdopen(file, "rb");
  if (stream == nullptr) {
    close(file);
    return unreadable(std::generic_category().message(errno));
  }
  return InputFile{path, stream, static_cast<std::uint64_t>(status.st_size)};
}

Unexpected InputFile::failed() const {
  return Unexpected{
      {ErrorCode::Unavailable, fmt::format("{}: reading failed: {}", shown(path_.string()),
                                           std::generic_category().message(errno))}};
}

Expected<std::size_t> InputFile::read(std::span<char> buffer) {
  const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file_.get());
  if (std::ferror(file_.get()) != 0) {
    return failed();
  }
  return count;
}

Expected<void> InputFile::rewind() {
  if (std::fseek(file_.get(), 0, SEEK_SET) != 0) {
    return failed();
  }
  return {};
}

Expected<std::string> read_text_file(const std::filesystem::path& path, std::uint64_t most_bytes) {
  auto file = InputFile::open(path, most_bytes);
  if (!file) {
    return Unexpected{std::move(file.error())};
  }
  std::string text(file->size(), '\0');
  return file->read(text).map([&text](std::size_t count) {
    text.resize(count);
    return std::move(text);
  });
}

}  // namespace spindrift
