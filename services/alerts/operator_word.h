/// @file
/// An operator's acknowledgement or shelving of an alert.

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
  int minutes = 0;  ///< Duration of shelving; 0 acknowledges.
};

/// Applies it to an alert of `desk` from now on. @return What was stored and announced;
/// InvalidInput when no such alert is open or it is in that state already; the archive's error.
Expected<ArchiveBatch> take_word(const OperatorWord& word, AlertDesk& desk, Archive& archive);

}  // namespace spindrift
