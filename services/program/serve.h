/// @file
/// `spindrift serve`: the service. Pulses in from the bus, pipelines, archive, results out.

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

struct ServeOptions {
  std::vector<std::filesystem::path> missions;
  std::filesystem::path db;
  std::uint32_t domain = 0;
  std::string partition = "live";
  std::string webhook;  ///< URL of an Alertmanager that is told the alerts; empty: none.
  std::string console;  ///< HOST:PORT; empty: no console.
  std::vector<std::string> console_hosts;  ///< Names by which browsers may call it.
  bool json = false;
};

/// Runs until SIGINT, SIGTERM or SIGHUP, then stores everything that was taken and prints its
/// summary.
/// @return InvalidConfiguration for bad input; Unavailable when the bus or the archive failed.
Expected<void> serve(const ServeOptions& options);

}  // namespace spindrift
