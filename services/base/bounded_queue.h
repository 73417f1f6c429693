/// @file
/// The queue through which threads exchange data; a full queue blocks its producers.

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

namespace spindrift {

/// A queue for many producers and one consumer. Nothing is ever dropped: a full queue blocks
/// `push`, which slows down the producers. After `close()` pushes are refused, while queued items
/// can still be taken.
template <class T>
class BoundedQueue {
 public:
  using Weigh = std::function<std::size_t(const T&)>;

  /// @param capacity Sum of the weights by `weigh`, by default the number of items.
  explicit BoundedQueue(
      std::size_t capacity, Weigh weigh = [](const T& /*item*/) { return std::size_t{1}; })
      : capacity_{capacity}, weigh_{std::move(weigh)} {}

  /// Waits until less than the capacity is queued. @return False when the queue is closed, and
  /// `item` was not taken.
  bool push(T item) {
    const std::size_t weight = weigh_(item);
    std::unique_lock lock{mutex_};
    room_.wait(lock, [this] { return closed_ || queued_ < capacity_; });
    if (closed_) {
      return false;
    }
    items_.push_back(std::move(item));
    queued_ += weight;
    lock.unlock();
    filled_.notify_one();
    return true;
  }

  /// Pushes without waiting for room, for the few items that somebody waits for.
  bool push_at_once(T item) {
    const std::size_t weight = weigh_(item);
    {
      const std::lock_guard lock{mutex_};
      if (closed_) {
        return false;
      }
      items_.push_back(std::move(item));
      queued_ += weight;
    }
    filled_.notify_one();
    return true;
  }

  /// Waits for the next item; empty only when closed and drained.
  std::optional<T> take() {
    std::unique_lock lock{mutex_};
    filled_.wait(lock, [this] { return closed_ || !items_.empty(); });
    return take_first(lock);
  }

  /// Works as `take`, but returns empty at `deadline` at the latest.
  std::optional<T> take_until(std::chrono::steady_clock::time_point deadline) {
    std::unique_lock lock{mutex_};
    filled_.wait_until(lock, deadline, [this] { return closed_ || !items_.empty(); });
    return take_first(lock);
  }

  /// Returns whether the queue is closed and empty, so that no item will come.
  bool is_drained() const {
    const std::lock_guard lock{mutex_};
    return closed_ && items_.empty();
  }

  void close() {
    {
      const std::lock_guard lock{mutex_};
      closed_ = true;
    }
    room_.notify_all();
    filled_.notify_all();
  }

  std::size_t size() const {
    const std::lock_guard lock{mutex_};
    return items_.size();
  }

 private:
  std::optional<T> take_first(std::unique_lock<std::mutex>& lock) {
    if (items_.empty()) {
      return std::nullopt;
    }
    std::optional<T> taken{std::move(items_.front())};
    items_.pop_front();
    queued_ -= weigh_(*taken);
    lock.unlock();
    room_.notify_all();
    return taken;
  }

  const std::size_t capacity_;
  const Weigh weigh_;
  mutable std::mutex mutex_;
  std::condition_variable room_;
  std::condition_variable filled_;
  std::deque<T> items_;
  std::size_t queued_ = 0;  ///< Sum of weights.
  bool closed_ = false;
};

}  // namespace spindrift
