#include "services/simulation/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "pipelines/core/shown.h"

namespace spindrift {

Unexpected OutputFile::failed() const {
  return Unexpected{
      {ErrorCode::Unavailable, fmt::format("{}: cannot be written: {}", shown(path_.string()),
                                           std::generic_category().message(errno))}};
}

Expected<OutputFile> OutputFile::create(const std::filesystem::path& path) {
  std::error_code unknown;
  if (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown)) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{}: is there and is no file, which would be replaced: name "
                                   "another",
                                   shown(path.string()))}};
  }
  std::filesystem::path beside = path;
  beside += ".partial";
  OutputFile file{path, beside, std::fopen(beside.c_str(), "wb")};
  if (!file.file_) {
    const bool no_place = errno != ENOSPC;
    Unexpected failed = file.failed();
    if (no_place) {
      failed.value().code = ErrorCode::InvalidConfiguration;
    }
    return failed;
  }
  return file;
}

OutputFile::~OutputFile() {
  if (file_) {
    std::error_code ignored;
    std::filesystem::remove(beside_, ignored);
  }
}

Expected<void> OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) {
    return failed();
  }
  return {};
}

Expected<void> OutputFile::commit() {
  // A full disk may report the error only here.
  if (std::fflush(file_.get()) != 0 || fsync(fileno(file_.get())) != 0 ||
      std::rename(beside_.c_str(), path_.c_str()) != 0) {
    return failed();
  }
  file_.reset();
  return {};
}

Expected<void> write_file(const std::filesystem::path& path, std::string_view text) {
  auto file = OutputFile::create(path);
  if (!file) {
    return Unexpected{std::move(file.error())};
  }
  return file->write(text).and_then([&] { return file->commit(); });
}

}  // namespace spindrift
