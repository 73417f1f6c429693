#include "services/telemetry_files/telemetry_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

#include "pipelines/core/shown.h"

namespace spindrift {
namespace {

Unexpected refused(const std::filesystem::path& path, std::string_view reason) {
  return Unexpected{
      {ErrorCode::InvalidConfiguration, fmt::format("{}: {}", shown(path.string()), reason)}};
}

Expected<std::vector<std::filesystem::path>> csv_files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  try {
    for (const auto& entry : std::filesystem::directory_iterator{folder}) {
      if (entry.path().extension() == ".csv" && entry.is_regular_file()) {
        files.push_back(entry.path());
      }
    }
  } catch (const std::filesystem::filesystem_error& error) {
    return refused(folder, error.code().message());
  }
  if (files.empty()) {
    return refused(folder, "there is no *.csv in this directory");
  }
  std::sort(files.begin(), files.end());
  return files;
}

Expected<TelemetryFile> recognised(const std::filesystem::path& path) {
  if (const auto file = InputFile::open(path); file && file->size() == 0) {
    return TelemetryFile{.path = path, .kind = std::nullopt};
  }
  return open_telemetry(path).map([&](const OpenTelemetry& opened) {
    return TelemetryFile{.path = path, .kind = opened.layout.kind};
  });
}

}  // namespace

Expected<std::vector<TelemetryFile>> scan_telemetry(std::span<const std::filesystem::path> paths) {
  std::vector<TelemetryFile> files;
  std::vector<std::string> problems;
  for (const auto& path : paths) {
    std::error_code not_there;  // Opening the file then says so.
    const auto found = std::filesystem::is_directory(path, not_there)
                           ? csv_files_in(path)
                           : Expected<std::vector<std::filesystem::path>>{{path}};
    if (!found) {
      problems.push_back(found.error().message);
      continue;
    }
    for (const auto& file_path : *found) {
      auto file = recognised(file_path);
      if (file) {
        files.push_back(std::move(*file));
      } else {
        problems.push_back(std::move(file.error().message));
      }
    }
  }
  if (!problems.empty()) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration, fmt::format("{}", fmt::join(problems, "\n"))}};
  }
  return files;
}

}  // namespace spindrift
