#include "services/program/comparison_notice.h"

#include <fmt/format.h>

#include "services/archive/submit_all.h"
#include "services/base/decimals.h"
#include "services/processor/told.h"

namespace spindrift {

std::string sentence_of(const Disagreement& disagreement) {
  constexpr int kWithoutSigma = 3;
  const double sigma_deg = disagreement.apart_deg / disagreement.apart_sigmas;
  return fmt::format(
      "{} and {} disagree: their axes are {:.{}f} deg apart, {:.1f} times the sigma of their "
      "difference",
      disagreement.one, disagreement.other, disagreement.apart_deg,
      decimals_for(sigma_deg, kWithoutSigma), disagreement.apart_sigmas);
}

std::vector<RunNotice> told_disagreements(const std::filesystem::path& db,
                                          const std::string& spacecraft_id,
                                          const std::string& run_id) {
  const auto found = find_disagreements(db, run_id);
  if (!found) {
    return {
        told("not_compared",
             {{"spacecraft", spacecraft_id}, {"run_id", run_id}, {"why", found.error().message}},
             fmt::format("{}: the estimators of run {} are not compared: {}", spacecraft_id, run_id,
                         found.error().message))};
  }
  std::vector<RunNotice> notices;
  for (const Disagreement& disagreement : *found) {
    notices.push_back(told("estimators_disagree",
                           {{"spacecraft", spacecraft_id},
                            {"one", disagreement.one},
                            {"other", disagreement.other},
                            {"apart_deg", disagreement.apart_deg},
                            {"apart_sigmas", disagreement.apart_sigmas}},
                           fmt::format("{}: {}", spacecraft_id, sentence_of(disagreement))));
  }
  return notices;
}

void DisagreementNotices::tell(std::span<const ArchiveBatch> stored) {
  for (const ArchiveBatch& batch : stored) {
    if (!batch.finished_utc) {
      continue;
    }
    ArchiveBatch told;
    told.run_id = batch.run_id;
    told.spacecraft_id = batch.spacecraft_id;
    for (RunNotice& notice : told_disagreements(db_, batch.spacecraft_id, batch.run_id)) {
      told.products.emplace_back(std::move(notice));
    }
    if (!told.products.empty()) {
      const std::lock_guard lock{mutex_};
      kept_.push_back(std::move(told));
    }
  }
}

Expected<void> DisagreementNotices::store(Archive& archive) {
  return archive.flush().and_then([&] {
    std::unique_lock lock{mutex_};
    std::vector<ArchiveBatch> kept = std::exchange(kept_, {});
    lock.unlock();
    return submit_all(archive, std::move(kept));
  });
}

}  // namespace spindrift
