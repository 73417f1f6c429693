/// @file
/// Estimators of one pass that disagree: the rule is that of the view spin_comparison.

#pragma once

#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/archive.h"
#include "services/products/run_notice.h"

namespace spindrift {

/// Warns of each two that do, by what is stored.
std::vector<RunNotice> told_disagreements(const std::filesystem::path& db,
                                          const std::string& spacecraft_id,
                                          const std::string& run_id);

/// Those of the runs of a service, whose archive is still open when they end.
class DisagreementNotices {
 public:
  explicit DisagreementNotices(std::filesystem::path db) : db_{std::move(db)} {}

  /// Warns of those of runs that end in what was just stored, and keeps the notices: the thread
  /// that stores must not wait for room in its own queue.
  void tell(std::span<const ArchiveBatch> stored);

  /// The notices of all that was submitted until now. On another thread.
  Expected<void> store(Archive& archive);

 private:
  std::filesystem::path db_;
  std::mutex mutex_;
  std::vector<ArchiveBatch> kept_;
};

}  // namespace spindrift
