/// @file
/// The topics of spindrift, each with its name and type, since several topics may share a type.

#pragma once

#include <dds/dds.h>

// The generated types, declared here because only adapters need their header.
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
