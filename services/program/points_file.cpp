#include "services/program/points_file.h"

#include <fmt/format.h>

#include "pipelines/core/shown.h"
#include "services/base/input_file.h"
#include "services/program/outcome.h"

namespace spindrift {

Expected<void> for_each_row(const std::filesystem::path& path, std::string_view header,
                            const std::function<Expected<void>(const FileLine&)>& take) {
  auto file = InputFile::open(path, kMostTextBytes);
  if (!file) {
    return Unexpected{file.error()};
  }
  FileLines lines{std::move(*file)};
  FileLine line{};
  auto more = lines.next(line);
  if (more && (!*more || line.text != header)) {
    return refused(fmt::format("{}: must begin with the header {}", shown(path.string()), header));
  }
  while ((more = lines.next(line)) && *more) {
    if (const auto taken = take(line); !taken) {
      return refused(
          fmt::format("{}:{}: {}", shown(path.string()), line.number, taken.error().message));
    }
  }
  return more ? Expected<void>{} : Unexpected{more.error()};
}

}  // namespace spindrift
