/// @file
/// The last events that viewers were told, as the text of an event stream.

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

  /// @param id Below that of the first event. One that rises from start to start of the service
  /// lets
  ///           a viewer of before have all that is new.
  explicit EventRing(std::uint64_t id) : last_id_{id} {}

  void add(std::string_view event, const nlohmann::json& data);

  struct News {
    std::string text;
    std::uint64_t last;  ///< `id` of the last of them.
  };
  /// `id`, or what is nearest to it of those behind which nothing has been forgotten.
  std::uint64_t nearest(std::uint64_t id) const;
  /// Behind `id`, or from the oldest that is kept; at most some 64 KiB at once.
  News after(std::uint64_t id) const;
  /// Nothing behind `id` has been forgotten.
  bool holds_all_after(std::uint64_t id) const { return id >= forgotten(); }

 private:
  std::uint64_t forgotten() const { return last_id_ - texts_.size(); }

  std::deque<std::string> texts_;
  std::size_t bytes_ = 0;
  std::uint64_t last_id_;
};

}  // namespace spindrift
