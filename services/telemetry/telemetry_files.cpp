#include "services/telemetry/telemetry_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
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

/// Returns the last `parts` elements of the path.
std::filesystem::path end_of(const std::filesystem::path& path, std::size_t parts) {
  std::filesystem::path end;
  const auto all = std::distance(path.begin(), path.end());
  for (auto part = std::next(path.begin(),
                             std::max<std::ptrdiff_t>(all - static_cast<std::ptrdiff_t>(parts), 0));
       part != path.end(); ++part) {
    end /= *part;
  }
  return end;
}

std::size_t parts_of(const std::filesystem::path& path) {
  return static_cast<std::size_t>(std::distance(path.begin(), path.end()));
}

/// Names that are still shared have one path, so their samples are the same.
void name_sources(std::vector<TelemetryFile>& files) {
  for (TelemetryFile& file : files) {
    const auto path = file.path.lexically_normal();
    std::size_t parts = 1;
    const auto is_shared = [&] {
      return std::any_of(files.begin(), files.end(), [&](const TelemetryFile& other) {
        const auto other_path = other.path.lexically_normal();
        return other_path != path && end_of(other_path, parts) == end_of(path, parts);
      });
    };
    while (parts < parts_of(path) && is_shared()) {
      ++parts;
    }
    file.source = shown(end_of(path, parts).string());
  }
}

}  // namespace

std::string find_source(std::span<const TelemetryFile> files, const std::string& name) {
  const auto wanted = std::filesystem::path{name}.lexically_normal();
  std::string found;
  for (const TelemetryFile& file : files) {
    const auto path = file.path.lexically_normal();
    if (path == wanted) {
      return file.source;
    }
    if (end_of(path, parts_of(wanted)) == wanted && file.source != found) {
      if (!found.empty()) {
        return {};
      }
      found = file.source;
    }
  }
  return found;
}

Expected<std::vector<TelemetryFile>> scan_telemetry(std::span<const std::filesystem::path> paths) {
  std::vector<TelemetryFile> files;
  std::vector<std::string> problems;
  for (const auto& path : paths) {
    std::error_code not_there;  // A missing path is reported on opening it.
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
  name_sources(files);
  return files;
}

}  // namespace spindrift
