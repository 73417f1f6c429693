#include "services/serving/alert_outbox.h"

#include <utility>

#include "services/base/contained.h"

namespace spindrift {

// A refusal of the archive is not reported here: whoever closes the archive gets the error.
AlertOutbox::AlertOutbox(Archive& archive, AlertDesk& desk, Announce announce,
                         ThreadFailures& failures)
    : archive_{archive}, desk_{desk}, announce_{std::move(announce)}, thread_{[this, &failures] {
        failures.note(contained("storing alerts", [this] {
          while (auto batch = waiting_.take()) {
            if (!archive_.submit(*std::move(batch))) {
              return;
            }
          }
        }));
      }} {}

AlertOutbox::~AlertOutbox() {
  waiting_.close();
  thread_.join();
}

void AlertOutbox::push(ArchiveBatch batch) {
  announce_(batch);
  if (waiting_.size() < kMostWaiting) {
    waiting_.push(std::move(batch));
  } else {
    desk_.take_back(batch);
  }
}

}  // namespace spindrift
