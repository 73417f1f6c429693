#include "services/bus/topics.h"

#include <spindrift.h>

namespace spindrift::bus {

const Topic<spindrift_Health> kHealthTopic{"spindrift/health", &spindrift_Health_desc};
const Topic<spindrift_RehearsalClock> kRehearsalClockTopic{"spindrift/rehearsal_clock",
                                                           &spindrift_RehearsalClock_desc};

}  // namespace spindrift::bus
