/// @file
/// Holds results that wait to be published. Adding a result never waits.

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/products/products.h"

namespace spindrift {

struct Announcement {
  std::string spacecraft;
  std::string run_id;
  Product product;  ///< A product of a kind that is announced.
  std::optional<std::chrono::steady_clock::time_point> came = {};  ///< As ArchiveBatch::came.
};

/// Queue of results: any thread adds, one takes. Beyond kMaxWaiting only the latest of each
/// instance on the bus is kept, which is all that a subscriber with keep-last 1 would see.
class Announcements {
 public:
  static constexpr std::size_t kMaxWaiting = 4096;

  /// Adds those of `products` that are announced. @param came As ArchiveBatch::came.
  void enqueue(const std::string& spacecraft, const std::string& run_id,
               std::span<const Product> products,
               std::optional<std::chrono::steady_clock::time_point> came = {});

  /// Waits for at least one announcement and takes all. Those of a spacecraft and kind keep their
  /// order. Empty only when the queue is closed and drained.
  std::vector<Announcement> take_all();

  void close();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Announcement> waiting_;
  bool closed_ = false;
};

}  // namespace spindrift
