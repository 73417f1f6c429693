#include <fmt/format.h>
#include <sys/statfs.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "services/doctor/disk.h"

namespace spindrift::doctor {

Expected<DiskFacts> disk_facts(const std::filesystem::path& db) {
  const std::filesystem::path folder = db.has_parent_path() ? db.parent_path() : ".";
  struct statfs found {};
  if (statfs(folder.c_str(), &found) != 0) {
    return Unexpected{
        {ErrorCode::Unavailable,
         fmt::format("{}: {}", folder.string(), std::generic_category().message(errno))}};
  }
  const bool writable = access(folder.c_str(), W_OK | X_OK) == 0 &&
                        (access(db.c_str(), F_OK) != 0 || access(db.c_str(), W_OK) == 0);
  return DiskFacts{.folder = folder.string(),
                   .writable = writable,
                   .free_bytes = static_cast<std::uint64_t>(found.f_bavail) *
                                 static_cast<std::uint64_t>(found.f_bsize),
                   .file_system = static_cast<std::uint64_t>(found.f_type)};
}

}  // namespace spindrift::doctor
