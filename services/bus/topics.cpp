#include "services/bus/topics.h"

#include <spindrift.h>

namespace spindrift::bus {

const Topic<spindrift_Health> kHealthTopic{"spindrift/health", &spindrift_Health_desc};

}  // namespace spindrift::bus
