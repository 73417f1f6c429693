/// @file
/// The version of the program, stored with every run.

#pragma once

namespace spindrift {

/// Version and, for a git checkout, its commit, with "-dirty" when it had changes.
extern const char* const kSoftwareVersion;

}  // namespace spindrift
