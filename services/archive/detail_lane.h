/// @file
/// The queue of details (the data that results rest on), which wait for more of their own run.

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

/// Collects details, for which nobody waits. The details of one table and run share pages, and each
/// commit that changes a page puts the whole page into the log. They are therefore stored many
/// revolutions at a time and little more than a second late, and one table at a time, since results
/// wait for a commit that has begun. If the service is killed, they are made again from the
/// samples.
class DetailLane {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  /// @param batch Holds only details of one table.
  void push(ArchiveBatch batch, Instant now);

  /// Takes details of the run and table due first, oldest first, until they have `rows` rows.
  std::vector<ArchiveBatch> take_due(Instant now, std::size_t rows);
  std::vector<ArchiveBatch> take_all(const std::string& run_id);

  /// Returns when the next details are due; empty when there are none. Must be cheap, as it is
  /// called at every push and commit.
  std::optional<Instant> next_due() const;

  std::size_t rows() const { return rows_; }
  std::size_t size() const;

 private:
  struct Waiting {
    std::deque<ArchiveBatch> batches;
    std::size_t rows;
    Instant since;
  };
  using Groups = std::map<std::pair<std::string, std::size_t>, Waiting>;

  static Instant due(const Waiting& waiting);
  void move(Groups::iterator group, std::size_t rows, std::vector<ArchiveBatch>& taken);

  Groups waiting_;
  std::set<std::pair<Instant, const Groups::key_type*>> by_due_;  ///< Every group of `waiting_`.
  std::size_t rows_ = 0;
};

}  // namespace spindrift
