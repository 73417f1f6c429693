/// @file
/// What of an archive can be had as a series.

#pragma once

#include <string>
#include <vector>

#include "services/mission/spacecraft_kind.h"

namespace spindrift {

struct Quantity {
  std::string name;
  std::string unit;
  /// Rows of t_tai_ns, value, accepted, rejected_by, for some also off, limit, unit and, behind
  /// these, used; the newest first. ?1: the run; ?2: up to.
  std::string sql;
};

/// Of all spacecraft of a kind, whatever their archives hold.
const std::vector<Quantity>& quantities_of(SpacecraftKind kind);

}  // namespace spindrift
