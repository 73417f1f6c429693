#include "services/bus/topics.h"

#include <spindrift.h>

namespace spindrift::bus {

const Topic<spindrift_Pulse> kPulseTopic{"spindrift/pulse", &spindrift_Pulse_desc};
const Topic<spindrift_CodedFrame> kCodedFrameTopic{"spindrift/coded_frame",
                                                   &spindrift_CodedFrame_desc};
const Topic<spindrift_Health> kHealthTopic{"spindrift/health", &spindrift_Health_desc};

}  // namespace spindrift::bus
