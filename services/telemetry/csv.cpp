#include "services/telemetry/csv.h"

#include "pipelines/core/shown.h"

namespace spindrift {

CsvFields::CsvFields(std::string_view line) {
  while (true) {
    const std::size_t comma = line.find(',');
    if (count_ < kMost) {
      fields_.at(count_) = line.substr(0, comma);
    }
    ++count_;
    if (comma == std::string_view::npos) {
      return;
    }
    line.remove_prefix(comma + 1);
  }
}

std::string_view CsvFields::remove(std::size_t column) {
  const std::string_view removed = fields_.at(column);
  std::copy(fields_.begin() + static_cast<std::ptrdiff_t>(column) + 1, fields_.end(),
            fields_.begin() + static_cast<std::ptrdiff_t>(column));
  --count_;
  return removed;
}

std::string quoted(std::string_view text) { return "\"" + shown(text) + "\""; }

}  // namespace spindrift
