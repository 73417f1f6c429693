/// @file
/// Announces results once they are stored, on a thread of its own.

#pragma once

#include <span>
#include <string>
#include <thread>
#include <variant>

#include "pipelines/spin/products.h"
#include "services/archive/records.h"
#include "services/publisher/result_publisher.h"
#include "services/queue/bounded_queue.h"

namespace spindrift {

class Announcer {
 public:
  /// `publisher` outlives it.
  explicit Announcer(const ResultPublisher& publisher);
  ~Announcer();
  Announcer(const Announcer&) = delete;
  Announcer& operator=(const Announcer&) = delete;
  Announcer(Announcer&&) = delete;
  Announcer& operator=(Announcer&&) = delete;

  /// Of what the archive has just committed; waits while it cannot follow.
  void committed(std::span<const ArchiveBatch> batches);

 private:
  struct Result {
    std::string spacecraft;
    std::variant<SpinFix, SpinEstimate> product;
  };

  void run();

  const ResultPublisher& publisher_;
  BoundedQueue<Result> queue_;
  std::thread thread_;  // Last: it uses the others.
};

}  // namespace spindrift
