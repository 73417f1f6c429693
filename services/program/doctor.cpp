#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "pipelines/time/utc.h"
#include "services/base/wall_clock.h"
#include "services/doctor/archive.h"
#include "services/doctor/disk.h"
#include "services/doctor/host.h"
#include "services/doctor/missions.h"
#include "services/doctor/network.h"
#include "services/doctor/presence.h"
#include "services/doctor/report.h"
#include "services/mission/mission.h"
#include "services/program/commands.h"
#include "services/program/outcome.h"
#include "services/program/utc_option.h"

namespace spindrift {
namespace {

using doctor::Check;

void append(std::vector<Check>& checks, std::vector<Check> more) {
  checks.insert(checks.end(), std::make_move_iterator(more.begin()),
                std::make_move_iterator(more.end()));
}

Expected<doctor::ComingPass> coming_pass(const DoctorOptions& options) {
  if (options.from.empty()) {
    const TaiTime now = tai_now();
    return doctor::ComingPass{.from = now, .to = now};
  }
  const auto from = utc_option("--from", options.from);
  const auto to = utc_option("--to", options.to);
  if (!from || !to) {
    return Unexpected{from ? to.error() : from.error()};
  }
  if (*from >= *to) {
    return refused(fmt::format("--from {} must lie before --to {}", options.from, options.to));
  }
  return doctor::ComingPass{.from = *from, .to = *to};
}

Expected<std::vector<doctor::MissionFacts>> look_at_missions(
    const std::vector<std::filesystem::path>& paths, const doctor::ComingPass& pass) {
  std::vector<doctor::MissionFacts> missions;
  std::string problems;
  for (const std::filesystem::path& path : paths) {
    if (const auto mission = load_mission(path)) {
      missions.push_back(doctor::mission_facts(*mission, pass));
    } else {
      problems += (problems.empty() ? "" : "\n") + mission.error().message;
    }
  }
  if (!problems.empty()) {
    return refused(problems);
  }
  return missions;
}

/// Checks the bus step by step; each step needs the previous one.
std::vector<Check> check_bus(const bus::BusConfig& bus) {
  const auto network = doctor::network_facts(bus.domain);
  std::vector<Check> checks = doctor::check_network(network);
  if (!network.settings) {
    return checks;
  }
  const auto trip = doctor::round_trip(bus.domain);
  checks.push_back(doctor::check_round_trip(trip.duration_ms));
  if (const auto presence = doctor::presence_facts(bus, trip.partner)) {
    append(checks, doctor::check_presence(*presence));
  } else {
    checks.push_back(doctor::failure("programs on the bus", presence.error().message,
                                     "see the network configuration above"));
  }
  return checks;
}

std::vector<Check> check_storage(const std::filesystem::path& db, std::size_t spacecraft) {
  std::vector<Check> checks = doctor::check_disk(doctor::disk_facts(db), spacecraft);
  append(checks,
         doctor::check_archive(doctor::archive_facts(db), leap_seconds().back().tai_minus_utc_s));
  return checks;
}

}  // namespace

Expected<bool> run_doctor(const DoctorOptions& options) {
  const auto pass = coming_pass(options);
  if (!pass) {
    return Unexpected{pass.error()};
  }
  const auto missions = look_at_missions(options.missions, *pass);
  if (!missions) {
    return Unexpected{missions.error()};
  }
  std::vector<Check> checks = check_bus({.domain = options.domain, .partition = options.partition});
  append(checks, doctor::check_missions(*missions, *pass));
  if (!options.db.empty()) {
    append(checks, check_storage(options.db, missions->size()));
  }
  append(checks, doctor::check_host(doctor::host_facts()));
  checks.push_back(doctor::check_leap_seconds(leap_facts(pass->to)));
  fmt::print("{}",
             options.json ? doctor::to_json(checks) : doctor::to_text(checks, options.verbose));
  return doctor::worst_of(checks) != doctor::Verdict::Failure;
}

}  // namespace spindrift
