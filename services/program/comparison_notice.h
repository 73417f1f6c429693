/// @file
/// Notices about estimators of one pass that disagree, by the rule of the view spin_comparison.

#pragma once

#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/archive.h"
#include "services/archive/verdict.h"
#include "services/products/run_notice.h"

namespace spindrift {

/// Returns for example "mean and batch disagree: their axes are 0.310 deg apart, 4.2 times the
/// sigma of their difference".
std::string sentence_of(const Disagreement& disagreement);

/// Warns of every pair of estimators in the stored run that disagree, and returns the notices.
std::vector<RunNotice> told_disagreements(const std::filesystem::path& db,
                                          const std::string& spacecraft_id,
                                          const std::string& run_id);

/// Collects the disagreement notices of a service's runs; the archive is still open when they end.
class DisagreementNotices {
 public:
  explicit DisagreementNotices(std::filesystem::path db) : db_{std::move(db)} {}

  /// Warns of disagreements in the runs that end in `stored`, and keeps the notices instead of
  /// submitting them: the storing thread must not wait for room in its own queue.
  void tell(std::span<const ArchiveBatch> stored);

  /// Stores the notices of everything submitted so far. Never call it on the storing thread.
  Expected<void> store(Archive& archive);

 private:
  std::filesystem::path db_;
  std::mutex mutex_;
  std::vector<ArchiveBatch> kept_;
};

}  // namespace spindrift
