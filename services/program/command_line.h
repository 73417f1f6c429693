/// @file
/// The subcommands, their options, and the messages for a bad command line.

#pragma once

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <functional>
#include <string>

#include "pipelines/core/expected.h"
#include "services/program/commands.h"

namespace spindrift {

/// @name Exit statuses, beside EXIT_SUCCESS
/// @{
inline constexpr int kFailed = 1;
inline constexpr int kBadInput = 2;
/// @}

struct Request {
  BatchOptions batch;
  ProcessOptions process;
  ServeOptions serve;
  ReplayOptions replay;
  SimulateOptions simulate;
  DoctorOptions doctor;
  GeomagFieldOptions geomag_field;
  GeomagTableOptions geomag_table;
  GeomagLookupOptions geomag_lookup;
  GeomagStudyOptions geomag_study;
  GeometryOptions geometry;
  ReconstructOptions reconstruct;
  CompareOptions compare;
  AlertsOptions alerts;
  ActOptions act;
  std::function<Expected<void>()> run;
  int status = EXIT_SUCCESS;  ///< Exit status of a run that came to its end.
};

/// @param request Filled in by parsing; must outlive `app`.
void add_commands(CLI::App& app, Request& request);

/// Returns a message for people. @param error The exception thrown by parsing with `app`.
std::string what_is_wrong(const CLI::App& app, const CLI::ParseError& error);

}  // namespace spindrift
