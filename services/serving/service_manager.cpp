#include "services/serving/service_manager.h"

#include <systemd/sd-daemon.h>

namespace spindrift {

// Errors are ignored: without systemd there is nobody to notify.
void tell_manager_ready() { static_cast<void>(sd_notify(0, "READY=1")); }
void tell_manager_alive() { static_cast<void>(sd_notify(0, "WATCHDOG=1")); }
void tell_manager_stopping() { static_cast<void>(sd_notify(0, "STOPPING=1")); }

}  // namespace spindrift
