/// @file
/// Pages that a checkpoint writes, brought to the disk a few at a time.

#pragma once

namespace spindrift {

/// SQLite writes all pages of a checkpoint into the cache of the system and has them synced at
/// once; a commit whose own sync comes meanwhile waits until the disk has them all. In the thread
/// that holds one of these the disk gets them as they are written, and a commit waits for a few of
/// them.
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
