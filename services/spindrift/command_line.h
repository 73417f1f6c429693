/// @file
/// The subcommands, their options, and what a bad command line says.

#pragma once

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <functional>
#include <string>

#include "pipelines/core/expected.h"
#include "services/spindrift/act.h"
#include "services/spindrift/alerts.h"
#include "services/spindrift/batch.h"
#include "services/spindrift/compare.h"
#include "services/spindrift/doctor.h"
#include "services/spindrift/geomag.h"
#include "services/spindrift/geometry.h"
#include "services/spindrift/process.h"
#include "services/spindrift/reconstruct.h"
#include "services/spindrift/replay.h"
#include "services/spindrift/serve.h"
#include "services/spindrift/simulate.h"

namespace spindrift {

/// @name Exit statuses, beside EXIT_SUCCESS
/// @{
inline constexpr int kFailed = 1;
inline constexpr int kBadInput = 2;
/// @}

/// What the command line asks for.
struct Request {
  BatchOptions batch;
  ProcessOptions process;
  ServeOptions serve;
  ReplayOptions replay;
  SimulateOptions simulate;
  DoctorOptions doctor;
  GeomagFieldOptions geomag_field;
  GeometryOptions geometry;
  ReconstructOptions reconstruct;
  CompareOptions compare;
  AlertsOptions alerts;
  ActOptions act;
  std::function<Expected<void>()> run;
  int status = EXIT_SUCCESS;  ///< Of a run that came to its end.
};

/// @param request Outlives `app`. Parsing fills it in.
void add_commands(CLI::App& app, Request& request);

/// For people. @param error Of parsing `app`.
std::string what_is_wrong(const CLI::App& app, const CLI::ParseError& error);

}  // namespace spindrift
