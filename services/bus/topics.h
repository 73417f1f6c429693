/// @file
/// The topics of spindrift: name and type together, since one type may serve several.

#pragma once

#include <dds/dds.h>

// The generated types, named without their header: only an adapter needs to see inside.
struct spindrift_Health;
struct spindrift_RehearsalClock;

namespace spindrift::bus {

/// `Sample` is the generated C type of `type`.
template <class Sample>
struct Topic {
  const char* name;
  const dds_topic_descriptor_t* type;
};

extern const Topic<spindrift_Health> kHealthTopic;
extern const Topic<spindrift_RehearsalClock> kRehearsalClockTopic;

}  // namespace spindrift::bus
