#include "services/alerts/operator_word.h"

#include <chrono>

#include "services/base/wall_clock.h"

namespace spindrift {

Expected<ArchiveBatch> take_word(const OperatorWord& word, AlertDesk& desk, Archive& archive) {
  if (word.by.empty()) {
    return Unexpected{{ErrorCode::InvalidInput, "by: must be a text, not empty: who says so"}};
  }
  const TaiTime now = tai_now();
  auto batch = word.minutes > 0
                   ? desk.shelve(word.alert_id, now, now + std::chrono::minutes{word.minutes},
                                 word.by, word.note)
                   : desk.acknowledge(word.alert_id, now, word.by, word.note);
  return batch.and_then([&](const ArchiveBatch& changed) {
    return archive.submit(changed).and_then([&] { return archive.flush(); }).map([&] {
      return changed;
    });
  });
}

}  // namespace spindrift
