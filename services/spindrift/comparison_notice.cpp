#include "services/spindrift/comparison_notice.h"

#include <spdlog/spdlog.h>

#include "services/archive/disagreement.h"

namespace spindrift {

void warn_of_disagreements(const std::filesystem::path& db, std::span<const ArchiveBatch> stored) {
  for (const ArchiveBatch& batch : stored) {
    if (!batch.finished_utc) {
      continue;
    }
    const auto found = find_disagreements(db, batch.run_id);
    if (!found) {
      spdlog::warn("{}: the estimators of run {} are not compared: {}", batch.spacecraft_id,
                   batch.run_id, found.error().message);
      continue;
    }
    for (const Disagreement& disagreement : *found) {
      spdlog::warn("{}: {}", batch.spacecraft_id, sentence_of(disagreement));
    }
  }
}

}  // namespace spindrift
