/// @file
/// Brings the pages of a checkpoint to the disk a few at a time.

#pragma once

namespace spindrift {

/// While one of these exists in a thread, the pages that it writes go to the disk as they are
/// written. SQLite alone writes all pages of a checkpoint into the system's cache and then syncs
/// them at once, so that a commit's sync meanwhile waits for all; here it waits for a few.
class PacedWrites {
 public:
  PacedWrites();
  ~PacedWrites();
  PacedWrites(const PacedWrites&) = delete;
  PacedWrites& operator=(const PacedWrites&) = delete;
  PacedWrites(PacedWrites&&) = delete;
  PacedWrites& operator=(PacedWrites&&) = delete;
};

}  // namespace spindrift
