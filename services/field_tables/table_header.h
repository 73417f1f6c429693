/// @file
/// A C header with a table of the field, its lookup, and the true anomaly from a position fix or
/// from time: C99, without memory of its own, and with <math.h> only.

#pragma once

#include <string>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/geomagnetism/tables/field_table.h"

namespace spindrift {

struct HeaderTexts {
  std::string made_of;  ///< What the table is of, for a reader: spacecraft, model, date; one line.
  /// Name of the header's file without its ending: all names in it begin with it, so that a program
  /// may hold several tables. What is no letter, digit or underscore becomes an underscore.
  std::string name;
};

/// @param later_nt How far the field at the same anomaly is off a revolution later, on average.
/// @return Unobservable for an orbit without a plane.
Expected<std::string> header_of(const FieldTable& table, const KeplerOrbit& orbit,
                                const HeaderTexts& texts, double later_nt);

}  // namespace spindrift
