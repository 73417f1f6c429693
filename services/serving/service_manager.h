/// @file
/// Reports the state of the service to systemd if it started the service (sd_notify(3)).

#pragma once

namespace spindrift {

/// Reports that readers for every topic of telemetry exist.
void tell_manager_ready();
/// Reports that samples are taken, which feeds the watchdog of the unit.
void tell_manager_alive();
void tell_manager_stopping();

}  // namespace spindrift
