#include "services/console/event_ring.h"

#include <fmt/format.h>

#include <algorithm>

#include "services/base/json_line.h"

namespace spindrift {
namespace {

constexpr std::size_t kBytesAtOnce = 65'536;

}  // namespace

void EventRing::append(std::string_view event, const nlohmann::json& data) {
  texts_.push_back(
      fmt::format("id: {}\nevent: {}\ndata: {}\n", ++last_id_, event, json_line(data)));
  bytes_ += texts_.back().size();
  while (bytes_ > kBytesKept) {
    bytes_ -= texts_.front().size();
    texts_.pop_front();
  }
}

std::uint64_t EventRing::nearest(std::uint64_t id) const {
  return std::clamp(id, forgotten(), last_id_);
}

EventRing::News EventRing::after(std::uint64_t id) const {
  News news{.text = {}, .last = nearest(id)};
  while (news.last < last_id_ && news.text.size() < kBytesAtOnce) {
    news.text += texts_[static_cast<std::size_t>(news.last - forgotten())];
    ++news.last;
  }
  return news;
}

}  // namespace spindrift
