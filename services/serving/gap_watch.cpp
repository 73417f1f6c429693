#include "services/serving/gap_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace spindrift {

std::map<std::string, std::uint64_t> GapWatch::beat(
    const std::map<std::string, SequenceCounts>& by_source) {
  std::map<std::string, std::uint64_t> now;
  std::map<std::string, std::uint64_t> lasting;
  for (const auto& [source, counts] : by_source) {
    if (counts.missing == 0) {
      continue;
    }
    now.emplace(source, counts.missing);
    if (const auto before = before_.find(source); before != before_.end()) {
      lasting.emplace(source, std::min(before->second, counts.missing));
    }
  }
  before_ = std::move(now);
  return lasting;
}

std::string to_text(const std::map<std::string, std::uint64_t>& gaps) {
  std::string text;
  for (const auto& [source, missing] : gaps) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", source, missing);
  }
  return text;
}

}  // namespace spindrift
