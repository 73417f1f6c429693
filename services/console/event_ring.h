/// @file
/// Keeps the latest viewer events as text of an event stream.

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace spindrift {

class EventRing {
 public:
  static constexpr std::size_t kBytesKept = 16UL * 1024 * 1024;

  /// @param id Below the id of the first event. An id that rises with each start of the service
  ///        lets a viewer from before the start receive everything new.
  explicit EventRing(std::uint64_t id) : last_id_{id} {}

  void append(std::string_view event, const nlohmann::json& data);

  struct News {
    std::string text;
    std::uint64_t last;  ///< `id` of the last event in `text`.
  };
  /// Returns `id`, limited to the range after which no event has been dropped.
  std::uint64_t nearest(std::uint64_t id) const;
  /// Returns the events after `id`, or from the oldest kept; about 64 KiB at most at once.
  News after(std::uint64_t id) const;
  /// Returns whether no event after `id` has been dropped.
  bool holds_all_after(std::uint64_t id) const { return id >= forgotten(); }

 private:
  std::uint64_t forgotten() const { return last_id_ - texts_.size(); }

  std::deque<std::string> texts_;
  std::size_t bytes_ = 0;
  std::uint64_t last_id_;
};

}  // namespace spindrift
