/// @file
/// What systemd is told of the service, where it started it (sd_notify(3)).

#pragma once

namespace spindrift {

/// Readers for every topic of telemetry exist.
void tell_manager_ready();
/// Samples are taken: feeds the watchdog of the unit.
void tell_manager_alive();
void tell_manager_stopping();

}  // namespace spindrift
