#include "services/base/file_lines.h"

#include <algorithm>
#include <span>

namespace spindrift {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

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

Expected<bool> FileLines::next(FileLine& line) {
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

Expected<bool> FileLines::next_raw(FileLine& line) {
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

Expected<void> FileLines::skip_rest_of_long_line() {
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

Expected<void> FileLines::read_more() {
  buffer_.resize(kReadAtOnce);
  std::copy(rest_.begin(), rest_.end(), buffer_.begin());
  const std::size_t kept = rest_.size();
  return file_.read(std::span{buffer_}.subspan(kept)).map([&](std::size_t count) {
    rest_ = {buffer_.data(), kept + count};
    bytes_read_ += count;
    ended_ = kept + count < buffer_.size();
  });
}

}  // namespace spindrift
