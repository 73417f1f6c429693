#include "services/telemetry_files/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
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
    auto there = next_raw(line);
    if (!there || !*there) {
      return there;
    }
    line.number = ++number_;
    line.text = trimmed(line.text, number_ == 1);
  } while (line.text.empty());
  return true;
}

Expected<bool> CsvLines::next_raw(CsvLine& line) {
  if (const auto skipped = skip_rest_of_long_line(); !skipped) {
    return Unexpected{skipped.error()};
  }
  std::size_t end = rest_.find('\n');
  if (end == std::string_view::npos && rest_.size() <= kLongestLine && !ended_) {
    if (const auto read = read_more(); !read) {
      return Unexpected{read.error()};
    }
    end = rest_.find('\n');
  }
  if (rest_.empty()) {
    return false;
  }
  const std::size_t length = std::min(end, rest_.size());
  line.too_long = length > kLongestLine;
  line.text = rest_.substr(0, std::min(length, kLongestLine));
  in_long_line_ = line.too_long && end == std::string_view::npos;
  rest_.remove_prefix(std::min(length + 1, rest_.size()));
  return true;
}

Expected<void> CsvLines::skip_rest_of_long_line() {
  while (in_long_line_) {
    const std::size_t end = rest_.find('\n');
    in_long_line_ = end == std::string_view::npos && !ended_;
    rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
    if (in_long_line_) {
      if (auto read = read_more(); !read) {
        return read;
      }
    }
  }
  return {};
}

Expected<void> CsvLines::read_more() {
  buffer_.resize(kReadAtOnce);
  std::copy(rest_.begin(), rest_.end(), buffer_.begin());
  const std::size_t kept = rest_.size();
  file_.read(buffer_.data() + kept, static_cast<std::streamsize>(buffer_.size() - kept));
  if (file_.bad()) {
    return Unexpected{{ErrorCode::Unavailable,
                       fmt::format("{}: reading failed after line {}", path_.string(), number_)}};
  }
  const auto read = static_cast<std::size_t>(file_.gcount());
  rest_ = {buffer_.data(), kept + read};
  bytes_read_ += read;
  ended_ = file_.eof();
  return {};
}

}  // namespace spindrift
