#include "services/serving/service_manager.h"

#include <systemd/sd-daemon.h>

namespace spindrift {

// Without systemd there is nobody to tell, which is no failure.
void tell_manager_ready() { static_cast<void>(sd_notify(0, "READY=1")); }
void tell_manager_alive() { static_cast<void>(sd_notify(0, "WATCHDOG=1")); }
void tell_manager_stopping() { static_cast<void>(sd_notify(0, "STOPPING=1")); }

}  // namespace spindrift
