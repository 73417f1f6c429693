#include "services/archive/own_log.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <array>
#include <bit>
#include <fstream>
#include <utility>

#include "services/archive/connection.h"

namespace spindrift {
namespace {

/// Returns the salt in the header of a log; empty when there is no log that SQLite would read.
std::optional<std::uint32_t> salt_of(const std::filesystem::path& log) {
  // https://www.sqlite.org/fileformat2.html#walformat: big-endian numbers, the last bit of the
  // first says how checksums are made.
  constexpr std::uint32_t kLogMagic = 0x377f0682;
  constexpr std::size_t kSaltOffset = 16;
  std::array<unsigned char, 32> header{};
  std::ifstream file{log, std::ios::binary};
  file.read(reinterpret_cast<char*>(header.data()), header.size());
  const auto number = [&](std::size_t at) {
    return std::uint32_t{header.at(at)} << 24U | std::uint32_t{header.at(at + 1)} << 16U |
           std::uint32_t{header.at(at + 2)} << 8U | std::uint32_t{header.at(at + 3)};
  };
  return file && (number(0) & ~1U) == kLogMagic ? std::optional{number(kSaltOffset)} : std::nullopt;
}

struct Salts {
  std::int64_t salt;
  std::int64_t salt_before;
};

std::optional<Salts> salts_in(Expected<SQLite::Database> database) {
  if (!database) {
    return std::nullopt;
  }
  try {
    SQLite::Statement query{*database, "SELECT salt, salt_before FROM own_log"};
    return query.executeStep() ? std::optional{Salts{.salt = query.getColumn(0).getInt64(),
                                                     .salt_before = query.getColumn(1).getInt64()}}
                               : std::nullopt;
  } catch (const SQLite::Exception&) {
    return std::nullopt;
  }
}

}  // namespace

Expected<void> OwnLog::refuse_other(const std::filesystem::path& archive) {
  const std::filesystem::path log = log_of(archive);
  const auto salt = salt_of(log);
  const auto alone = salt ? salts_in(open_at_rest(archive)) : std::nullopt;
  if (!alone || *salt == static_cast<std::uint32_t>(alone->salt) ||
      *salt == static_cast<std::uint32_t>(alone->salt) + 1) {
    return {};
  }
  const auto with_log = salts_in(open_for_reading(archive));
  if (with_log && with_log->salt != alone->salt && with_log->salt_before == alone->salt) {
    return {};
  }
  return Unexpected{
      {ErrorCode::InvalidConfiguration,
       fmt::format(
           "archive {}: {} beside it is the log of another file, left by a program that was "
           "killed; taken together the two would be mixed, so that both were left "
           "untouched. Move the log away, or put the file back that it belongs to",
           archive.string(), log.string())}};
}

OwnLog::OwnLog(const std::filesystem::path& archive)
    : log_{log_of(archive)}, seen_{salt_of(log_)} {}

void OwnLog::expect_new(SQLite::Database& database) const {
  if (!seen_) {
    database.exec("UPDATE own_log SET salt_before = salt, salt = abs(random()) % 4294967296");
  }
}

void OwnLog::note(SQLite::Database& database) {
  const auto salt = salt_of(log_);
  if (!salt || (is_noted_ && salt == seen_)) {
    return;
  }
  const bool has_begun_anew = seen_ && salt != seen_;
  SQLite::Statement update{database, has_begun_anew
                                         ? "UPDATE own_log SET salt_before = salt, salt = ?1"
                                         : "UPDATE own_log SET salt = ?1"};
  update.bind(1, std::int64_t{*salt});
  update.exec();
  seen_ = salt;
  is_noted_ = true;
}

}  // namespace spindrift
