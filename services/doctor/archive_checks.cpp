#include <fmt/format.h>
#include <fmt/ranges.h>

#include "services/doctor/archive.h"

namespace spindrift::doctor {
namespace {

// Far above the 64 MiB to which the service truncates the log after a checkpoint.
constexpr std::uint64_t kLongLog_bytes = 256ULL << 20U;

Check check_integrity(const ArchiveContent& content) {
  const std::string name = "integrity";
  if (!content.damages.empty()) {
    return failure(name, fmt::format("{}", fmt::join(content.damages, "\n")),
                   "the archive is damaged: stop the service, keep the file, take another archive "
                   "for the pass, and save what can be read with sqlite3 ARCHIVE .recover");
  }
  if (content.orphans > 0) {
    return failure(name, fmt::format("{} rows refer to rows that are not there", content.orphans),
                   "another program has written this archive: restore a copy");
  }
  return ok(name, content.looked_at_everything
                      ? "no damage, everything refers to what is there"
                      : "no damage to its structure; too large to look at every index");
}

Check check_log(std::uint64_t wal_bytes) {
  const std::string name = "write-ahead log";
  const std::string found = fmt::format("{} MiB", wal_bytes >> 20U);
  return wal_bytes > kLongLog_bytes
             ? warning(name, found,
                       "a program that reads the archive holds it up: end readers that stay open")
             : ok(name, found);
}

Check check_writer(const ArchiveFacts& facts) {
  return facts.writer ? ok("writer", *facts.writer, "it must end before another can write")
                      : ok("writer", "nobody writes the archive now");
}

Check check_runs(const ArchiveFacts& facts) {
  const std::int64_t unfinished = facts.content->unfinished_runs;
  if (unfinished == 0) {
    return ok("runs", "all are finished");
  }
  const std::string found = fmt::format("{} not finished", unfinished);
  return facts.writer
             ? ok("runs", found + "; the writer's are among them")
             : warning(
                   "runs", found,
                   "a program was interrupted, killed or lost power; what it had stored is whole");
}

Check check_leap_table(int archive_s, int program_s) {
  const std::string name = "leap seconds of the archive";
  const std::string found =
      fmt::format("TAI - UTC = {} s; this program's is {} s", archive_s, program_s);
  if (archive_s == program_s) {
    return ok(name, found);
  }
  return archive_s < program_s
             ? warning(name, found, "times in UTC are right again when a run has opened it")
             : warning(name, found, "a newer program wrote it: install a newer liberfa1 here");
}

}  // namespace

std::vector<Check> check_archive(const ArchiveFacts& facts, int program_tai_minus_utc_s) {
  if (facts.content && !facts.exists) {
    return {ok("archive", fmt::format("{} is not there: it will be made", facts.path))};
  }
  if (!facts.content) {
    return {failure("archive", facts.content.error().message,
                    "take another file for the pass, or restore a copy of this one"),
            check_writer(facts)};
  }
  std::vector<Check> checks{
      ok("archive", fmt::format("{}, {} MiB", facts.path, facts.bytes >> 20U)),
      check_integrity(*facts.content), check_log(facts.wal_bytes), check_writer(facts)};
  if (facts.content->damages.empty()) {
    checks.push_back(check_runs(facts));
    checks.push_back(check_leap_table(facts.content->tai_minus_utc_s, program_tai_minus_utc_s));
  }
  return checks;
}

}  // namespace spindrift::doctor
