/// @file
/// Which program it was: kept with every run.

#pragma once

namespace spindrift {

/// Version and, where the tree was a git checkout, commit; "-dirty" when it had changes.
extern const char* const kSoftwareVersion;

}  // namespace spindrift
