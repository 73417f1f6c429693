/// @file
/// Where two threads meet, and the only place: a queue that makes its producer wait when full.

#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

namespace spindrift {

/// Many producers, one consumer. Nothing is ever dropped: a full queue blocks `push`, so pressure
/// goes back to whoever produces. After `close()` pushes are refused and what is queued can still
/// be taken.
template <class T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : capacity_{capacity} {}

  /// Waits for room. @return false when the queue is closed: `item` was not taken.
  bool push(T item) {
    std::unique_lock lock{mutex_};
    room_.wait(lock, [this] { return closed_ || items_.size() < capacity_; });
    if (closed_) {
      return false;
    }
    items_.push_back(std::move(item));
    lock.unlock();
    filled_.notify_one();
    return true;
  }

  /// Waits for at least one item and takes all there are; empty only when closed and drained.
  std::vector<T> take_all() {
    std::unique_lock lock{mutex_};
    filled_.wait(lock, [this] { return closed_ || !items_.empty(); });
    std::vector<T> taken{std::make_move_iterator(items_.begin()),
                         std::make_move_iterator(items_.end())};
    items_.clear();
    lock.unlock();
    room_.notify_all();
    return taken;
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
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable room_;
  std::condition_variable filled_;
  std::deque<T> items_;
  bool closed_ = false;
};

}  // namespace spindrift
