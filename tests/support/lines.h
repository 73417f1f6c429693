/// @file
/// Texts of lines, and telemetry files of which a test changes the rows.

#pragma once

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

namespace spindrift {

inline std::vector<std::string> lines_of(const std::string& text, char end = '\n') {
  std::vector<std::string> lines;
  std::istringstream stream{text};
  for (std::string line; std::getline(stream, line, end);) {
    lines.push_back(line);
  }
  return lines;
}

/// Returns a CSV text with each row replaced by `change(row)`, without those that it makes empty.
template <class Change>
std::string with_rows(const std::string& csv, const Change& change) {
  const std::size_t header = csv.find('\n') + 1;
  std::string changed = csv.substr(0, header);
  for (const std::string& row : lines_of(csv.substr(header))) {
    const std::string by = change(row);
    changed += by.empty() ? "" : by + "\n";
  }
  return changed;
}

/// Returns a row of telemetry with its first field, a time, later.
inline std::string later_row(const std::string& row, std::int64_t by_ns) {
  return std::to_string(std::stoll(row) + by_ns) + row.substr(row.find(','));
}

/// Returns a row of telemetry with each number after its time as `write` writes it.
template <class Write>
std::string with_numbers(const std::string& row, const Write& write) {
  const std::vector<std::string> fields = lines_of(row, ',');
  std::string changed = fields.at(0);
  for (std::size_t i = 1; i < fields.size(); ++i) {
    changed += "," + write(std::stod(fields[i]));
  }
  return changed;
}

}  // namespace spindrift
