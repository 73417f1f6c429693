#include "services/telemetry_files/csv.h"

#include <fmt/format.h>

#include <cerrno>
#include <limits>
#include <system_error>

namespace spindrift {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kShownCharacters = 80;

std::string_view trimmed(std::string_view text, bool first_line) {
  if (first_line && text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
  }
  if (text.ends_with('\r')) {
    text.remove_suffix(1);
  }
  return text;
}

}  // namespace

std::vector<std::string_view> csv_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (auto comma = line.find(','); comma != std::string_view::npos; comma = line.find(',')) {
    fields.push_back(line.substr(0, comma));
    line.remove_prefix(comma + 1);
  }
  fields.push_back(line);
  return fields;
}

std::string quoted(std::string_view text) {
  std::string shown = "\"";
  for (const char c : text.substr(0, kShownCharacters)) {
    shown += c >= ' ' && c <= '~' ? std::string{c}
                                  : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
  return shown + (text.size() > kShownCharacters ? "...\"" : "\"");
}

Expected<CsvLines> CsvLines::open(const std::filesystem::path& path) {
  const auto unreadable = [&](std::string_view reason) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{}: cannot be read: {}", path.string(), reason)}};
  };
  // A device has no end, and to open a pipe may wait for ever.
  std::error_code unknown;
  const auto status = std::filesystem::status(path, unknown);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return unreadable("not a regular file");
  }
  std::ifstream file{path, std::ios::binary};
  if (!file) {
    return unreadable(std::generic_category().message(errno));
  }
  return CsvLines{path, std::move(file)};
}

Expected<bool> CsvLines::next(CsvLine& line) {
  do {
    file_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    if (file_.bad()) {
      return Unexpected{{ErrorCode::Unavailable,
                         fmt::format("{}: reading failed after line {}", path_.string(), number_)}};
    }
    auto length = static_cast<std::size_t>(file_.gcount());
    if (length == 0) {
      return false;
    }
    line.number = ++number_;
    line.too_long = file_.fail();
    if (line.too_long) {
      file_.clear();
      file_.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    } else if (!file_.eof()) {
      --length;  // gcount() counts the line feed.
    }
    line.text = trimmed({buffer_.data(), length}, number_ == 1);
  } while (line.text.empty());
  return true;
}

}  // namespace spindrift
