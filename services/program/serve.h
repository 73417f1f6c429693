/// @file
/// `spindrift serve`: the service from bus telemetry to archived and published results.

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
  std::string webhook;  ///< URL of an Alertmanager to notify of alerts; empty means none.
  std::string console;  ///< HOST:PORT to listen on; empty means no console.
  std::vector<std::string> console_hosts;  ///< Host names under which browsers may reach it.
  bool json = false;
};

/// Runs until SIGINT, SIGTERM or SIGHUP, then stores everything that was taken and prints the
/// summary.
/// @return InvalidConfiguration for bad input; Unavailable when the bus or the archive failed.
Expected<void> serve(const ServeOptions& options);

}  // namespace spindrift
