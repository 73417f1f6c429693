/// @file
/// The quantities of the archive that are available as series.

#pragma once

#include <string>
#include <vector>

#include "services/mission/spacecraft_kind.h"

namespace spindrift {

struct Quantity {
  std::string name;
  std::string unit;
  /// Selects t_tai_ns, value, accepted, rejected_by, for some also off, limit, unit and then used;
  /// newest first. Parameter ?1 is the run, ?2 the latest time.
  std::string sql;
};

/// Returns the quantities for a kind of spacecraft, whether or not an archive has values of them.
const std::vector<Quantity>& quantities_of(SpacecraftKind kind);

}  // namespace spindrift
