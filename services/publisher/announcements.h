/// @file
/// Results that wait to be published. Who adds them never waits.

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
  Product product;                                                 ///< Of a kind that is announced.
  std::optional<std::chrono::steady_clock::time_point> came = {};  ///< As in ArchiveBatch.
};

/// Any thread adds, one takes. Beyond kMaxWaiting only the latest of each instance on the bus is
/// kept: that is what a subscriber with keep-last 1 would see of them anyhow.
class Announcements {
 public:
  static constexpr std::size_t kMaxWaiting = 4096;

  /// Those of `products` that are announced. @param came As in ArchiveBatch.
  void add(const std::string& spacecraft, const std::string& run_id,
           std::span<const Product> products,
           std::optional<std::chrono::steady_clock::time_point> came = {});

  /// Waits for at least one and takes all, those of a spacecraft and kind in the order they came;
  /// empty only when closed and drained.
  std::vector<Announcement> take_all();

  void close();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Announcement> waiting_;
  bool closed_ = false;
};

}  // namespace spindrift
