#include "services/spindrift/comparison_notice.h"

#include <fmt/format.h>

#include "services/archive/verdict.h"
#include "services/standard_error/warning.h"

namespace spindrift {

void warn_of_disagreements(const std::filesystem::path& db, std::span<const ArchiveBatch> stored) {
  for (const ArchiveBatch& batch : stored) {
    if (!batch.finished_utc) {
      continue;
    }
    const auto found = find_disagreements(db, batch.run_id);
    if (!found) {
      warn("not_compared",
           {{"spacecraft", batch.spacecraft_id},
            {"run_id", batch.run_id},
            {"why", found.error().message}},
           fmt::format("{}: the estimators of run {} are not compared: {}", batch.spacecraft_id,
                       batch.run_id, found.error().message));
      continue;
    }
    for (const Disagreement& disagreement : *found) {
      warn("estimators_disagree",
           {{"spacecraft", batch.spacecraft_id},
            {"one", disagreement.one},
            {"other", disagreement.other},
            {"apart_deg", disagreement.apart_deg},
            {"apart_sigmas", disagreement.apart_sigmas}},
           fmt::format("{}: {}", batch.spacecraft_id, sentence_of(disagreement)));
    }
  }
}

}  // namespace spindrift
