/// @file
/// Results that wait to be published. Who adds them never waits.

#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "pipelines/spin/types/products.h"

namespace spindrift {

struct Announcement {
  std::string spacecraft;
  std::string run_id;
  std::variant<SpinFix, SpinEstimate> product;
};

/// One thread adds, one takes. Beyond kMaxWaiting only the latest fix of each spacecraft, and the
/// latest estimate of each of its estimators, is kept: that is what a subscriber with keep-last 1
/// would see of them anyhow.
class Announcements {
 public:
  static constexpr std::size_t kMaxWaiting = 4096;

  /// Those of `products` that are announced: estimates, and fixes that are accepted or AMBIGUOUS.
  /// A fix from measurements that contradict each other could not be told from a good one.
  void add(const std::string& spacecraft, const std::string& run_id,
           std::span<const SpinProduct> products);

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
