/// @file
/// What an operator says about an alert.

#pragma once

#include <string>

#include "pipelines/core/expected.h"
#include "services/alerts/alert_desk.h"
#include "services/archive/archive.h"

namespace spindrift {

struct OperatorWord {
  std::string alert_id;
  std::string by;
  std::string note;
  int minutes = 0;  ///< Shelved for so long; 0: acknowledged.
};

/// Done to an alert of `desk`, from now on. @return what was stored and announced; InvalidInput
/// where no such alert is open, or it has been done already; the archive's refusal.
Expected<ArchiveBatch> take_word(const OperatorWord& word, AlertDesk& desk, Archive& archive);

}  // namespace spindrift
