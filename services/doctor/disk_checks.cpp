#include <fmt/format.h>
#include <linux/magic.h>

#include <algorithm>
#include <array>

#include "services/base/duration.h"
#include "services/doctor/disk.h"

namespace spindrift::doctor {
namespace {

// Bytes of a revolution with all six edges in this archive version: measured 2260 with
// deploy/scenarios/gto-nominal.toml, 2090 with geo-day.toml.
constexpr double kBytesPerRevolution = 2300.0;
constexpr double kFastSpin_rpm = 100.0;
constexpr double kLongPass_h = 24.0;
constexpr double kShortPass_h = 1.0;

struct FileSystem {
  std::uint64_t magic;
  const char* name;
};
// A write-ahead log needs shared memory and reliable locks, which network file systems lack
// (https://www.sqlite.org/wal.html).
constexpr std::array<FileSystem, 7> kNetworkFileSystems = {{{NFS_SUPER_MAGIC, "NFS"},
                                                            {SMB_SUPER_MAGIC, "SMB"},
                                                            {CIFS_SUPER_MAGIC, "CIFS"},
                                                            {SMB2_SUPER_MAGIC, "SMB2"},
                                                            {V9FS_MAGIC, "9P"},
                                                            {CEPH_SUPER_MAGIC, "Ceph"},
                                                            {AFS_SUPER_MAGIC, "AFS"}}};

Check check_space(const DiskFacts& facts, std::size_t spacecraft) {
  const double bytes_per_hour = kBytesPerRevolution * kFastSpin_rpm * 60.0 *
                                static_cast<double>(std::max<std::size_t>(spacecraft, 1));
  const double hours = static_cast<double>(facts.free_bytes) / bytes_per_hour;
  const std::string found = fmt::format("{} MiB free: {} of {} spacecraft at {:.0f} rpm",
                                        facts.free_bytes >> 20U, duration_text(hours * 3600.0),
                                        std::max<std::size_t>(spacecraft, 1), kFastSpin_rpm);
  const std::string advice = "make room, or put the archive on another disk";
  if (hours < kShortPass_h) {
    return failure("disk", found, advice);
  }
  return hours < kLongPass_h ? warning("disk", found, advice) : ok("disk", found);
}

Check check_file_system(const DiskFacts& facts) {
  const std::string name = "file system";
  const auto* const bad =
      std::find_if(kNetworkFileSystems.begin(), kNetworkFileSystems.end(),
                   [&](const FileSystem& system) { return system.magic == facts.file_system; });
  if (bad != kNetworkFileSystems.end()) {
    return failure(name, fmt::format("{} is on {}", facts.folder, bad->name),
                   "an archive there can be damaged: put it on a disk of this host");
  }
  return facts.file_system == TMPFS_MAGIC
             ? warning(name, fmt::format("{} is in memory only", facts.folder),
                       "it is gone when the host stops: put the archive on a disk")
             : ok(name, fmt::format("{} is on this host", facts.folder));
}

}  // namespace

std::vector<Check> check_disk(const Expected<DiskFacts>& facts, std::size_t spacecraft) {
  if (!facts) {
    return {failure("disk", facts.error().message, "make the folder, or name another archive")};
  }
  std::vector<Check> checks{check_space(*facts, spacecraft), check_file_system(*facts)};
  if (!facts->writable) {
    checks.push_back(failure("write access", fmt::format("{} cannot be written", facts->folder),
                             "run as the archive's owner, or change the owner"));
  }
  return checks;
}

}  // namespace spindrift::doctor
