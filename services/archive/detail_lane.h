/// @file
/// What results rest on, on its way to the writer thread: it waits for company of its own run.

#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "services/archive/records.h"

namespace spindrift {

/// Nobody waits for details, and those of one table and run stand in the same pages, which each
/// commit that changes them puts into the log as a whole. So they are stored many revolutions at a
/// time, one table at a time since results wait for a commit that has begun, and little more than a
/// second late; a service that is killed makes them again from the samples.
class DetailLane {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  /// @param batch With details only, of one table.
  void push(ArchiveBatch batch, Instant now);

  /// Of the run and table that have waited longest, if due: the oldest, until they have `rows`.
  std::vector<ArchiveBatch> take_due(Instant now, std::size_t rows);
  std::vector<ArchiveBatch> take_all(const std::string& run_id);

  /// When the next are. Empty: there are none. Asked at every push and commit.
  std::optional<Instant> next_due() const;

  std::size_t rows() const { return rows_; }
  std::size_t size() const;

 private:
  struct Waiting {
    std::deque<ArchiveBatch> batches;
    std::size_t rows;
    Instant since;
  };
  /// Of a run and a kind of product.
  using Groups = std::map<std::pair<std::string, std::size_t>, Waiting>;

  static Instant due(const Waiting& waiting);
  void move(Groups::iterator group, std::size_t rows, std::vector<ArchiveBatch>& taken);

  Groups waiting_;
  std::set<std::pair<Instant, const Groups::key_type*>> by_due_;  ///< All of `waiting_`.
  std::size_t rows_ = 0;
};

}  // namespace spindrift
