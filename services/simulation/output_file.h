/// @file
/// Output file that appears as a whole or not at all.

#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Writes a temporary file beside the path and moves it there on commit, replacing a file of the
/// same name; without a commit nothing is left.
class OutputFile {
 public:
  /// @return Unavailable with the path and the reason.
  static Expected<OutputFile> create(const std::filesystem::path& path);

  /// @return Unavailable with the path and the reason.
  Expected<void> write(std::string_view text);

  /// Moves the file to its path once on the disk. @return Unavailable with path and reason.
  Expected<void> commit();

  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  OutputFile(OutputFile&&) = default;
  OutputFile& operator=(OutputFile&&) = delete;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  OutputFile(std::filesystem::path path, std::filesystem::path beside, std::FILE* file)
      : path_{std::move(path)}, beside_{std::move(beside)}, file_{file} {}
  Unexpected failed() const;

  std::filesystem::path path_;
  std::filesystem::path beside_;
  std::unique_ptr<std::FILE, Close> file_;  ///< Empty once committed.
};

/// @return Errors of OutputFile.
Expected<void> write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace spindrift
