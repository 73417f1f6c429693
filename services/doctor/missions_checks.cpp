#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "pipelines/time/utc.h"
#include "services/base/decimals.h"
#include "services/base/duration.h"
#include "services/doctor/missions.h"
#include "services/mission/igrf.h"

namespace spindrift::doctor {
namespace {

constexpr double kDay_s = 86'400.0;

std::string coverage_text(const Coverage& coverage) {
  return fmt::format("ephemeris from {} to {}", format_utc(coverage.from, 0),
                     format_utc(coverage.to, 0));
}

/// Names the result that is missing without the orbit.
std::string orbit_advice(const MissionFacts& mission) {
  return fmt::format("get an ephemeris of the pass: {} without the orbit",
                     mission.kind == SpacecraftKind::Spin ? "there is no spin axis"
                                                          : "the magnetometer tells nothing");
}

/// Only an ephemeris can fail to cover a time.
std::string no_orbit_text(TaiTime t, const Coverage& coverage) {
  const std::string where =
      t < coverage.from ? duration_text(seconds_between(t, coverage.from)) + " before it begins"
      : t > coverage.to ? duration_text(seconds_between(coverage.to, t)) + " after it ends"
                        : "in a gap of it";
  return fmt::format("no orbit at {}, {}", format_utc(t, 0), where);
}

Check check_orbit(const MissionFacts& mission, const ComingPass& pass) {
  const std::string name = fmt::format("orbit of {}", mission.spacecraft);
  const std::string coverage =
      mission.ephemeris ? coverage_text(*mission.ephemeris) : "no ephemeris: any time";
  if (!mission.orbit_given) {
    return warning(name, "the mission file gives none, and orbit states may not come",
                   orbit_advice(mission));
  }
  if (!mission.ephemeris) {
    return ok(name, coverage);
  }
  const bool is_now = pass.from == pass.to;
  if (mission.no_orbit_at) {
    const bool nothing = mission.never_an_orbit && !is_now && mission.kind == SpacecraftKind::Spin;
    return (nothing ? failure : warning)(
        name,
        fmt::format("{}: {}", coverage, no_orbit_text(*mission.no_orbit_at, *mission.ephemeris)),
        orbit_advice(mission));
  }
  const double left_s = seconds_between(pass.to, mission.ephemeris->to);
  const std::string found = fmt::format("{}, another {}{}", coverage, duration_text(left_s),
                                        is_now ? "" : " behind the pass");
  return is_now && left_s < kDay_s ? warning(name, found, "get the next ephemeris now")
                                   : ok(name, found);
}

Check check_field(const MissionFacts& mission, const ComingPass& pass) {
  const std::string name = fmt::format("field coefficients of {}", mission.spacecraft);
  const std::string found =
      fmt::format("{} until {}", kFieldModelName, format_utc(*mission.field_to, 0));
  const bool is_now = pass.from == pass.to;
  const double left_s = seconds_between(pass.to, *mission.field_to);
  return left_s < (is_now ? kDay_s : 0.0)
             ? warning(name, fmt::format("{}: the magnetometer tells nothing behind that", found),
                       "install a program with the next generation of the field")
             : ok(name, found);
}

/// Called only for a mission that names a ground model.
Check check_model(const MissionFacts& mission, const ComingPass& pass) {
  const std::string name = fmt::format("ground model of {}", mission.spacecraft);
  if (!mission.ground_model) {
    return failure(name, mission.model_problem,
                   "mend the scenario, or take [ground_model] out: the service does not start");
  }
  const std::string found = fmt::format("from {} to {}", format_utc(mission.ground_model->from, 0),
                                        format_utc(mission.ground_model->to, 0));
  const bool is_now = pass.from == pass.to;
  const bool covers =
      (is_now || mission.ground_model->from <= pass.from) && pass.to <= mission.ground_model->to;
  return covers ? ok(name, found)
                : warning(name, fmt::format("{}: not for all of the pass", found),
                          "correct [pass] of the scenario: beyond it nothing is compared");
}

std::vector<Check> check_settings(const MissionFacts& mission) {
  const std::string name = fmt::format("mission {}", mission.spacecraft);
  std::vector<Check> checks;
  if (!mission.infrared) {
    checks.push_back(warning(name, "no infrared sensor: the sun angle alone gives no spin axis",
                             "describe the sensors in [spin.ir.north] and [spin.ir.south]"));
  }
  if (!mission.idle.empty()) {
    checks.push_back(warning(
        name, fmt::format("nothing reads [{}]", fmt::join(mission.idle, "], [")),
        fmt::format("take it out, or correct spacecraft.kind = \"{}\"", name_of(mission.kind))));
  }
  for (const std::string& doubt : mission.orbit_doubts) {
    checks.push_back(
        warning(name, doubt,
                "make sure that the orbit is that of this spacecraft, of one solution, and whole"));
  }
  if (checks.empty()) {
    checks.push_back(ok(name, "sound"));
  }
  return checks;
}

std::string default_text(const DefaultAlignment& one) {
  const std::string said = fmt::format("{} = {}", one.key, one.value);
  return one.cost_deg ? fmt::format("{}: {} deg{}{}", said, to_its_digits(*one.cost_deg, 2),
                                    one.where.empty() ? "" : " ", one.where)
                      : said;
}

/// A default of 0 costs nothing and needs no attention.
Check check_alignment(const MissionFacts& mission) {
  const std::string name = fmt::format("alignment of {}", mission.spacecraft);
  if (mission.defaults.empty()) {
    return ok(name, "stated in the mission file");
  }
  std::string found = "defaults in force, and what each adds to sigma";
  if (mission.planned) {
    found += fmt::format(" of the axis from {} to {}", format_utc(mission.planned->from, 0),
                         format_utc(mission.planned->to, 0));
  } else if (mission.kind == SpacecraftKind::Spin) {
    found =
        "defaults in force ([spin.target] or [spin.prior], and an orbit at the time of --from, "
        "would tell what each adds to sigma)";
  }
  bool all_exact = true;
  for (const DefaultAlignment& one : mission.defaults) {
    found += (&one == &mission.defaults.front() ? ":\n" : "\n") + default_text(one);
    all_exact = all_exact && one.value == 0.0;
  }
  return all_exact ? ok(name, found)
                   : warning(name, found,
                             fmt::format("say in [{}.alignment] how well the sensors are known",
                                         name_of(mission.kind)));
}

}  // namespace

std::vector<Check> check_missions(std::span<const MissionFacts> missions, const ComingPass& pass) {
  std::vector<Check> checks;
  std::set<std::string> known;
  for (const MissionFacts& mission : missions) {
    if (!known.insert(mission.spacecraft).second) {
      checks.push_back(failure(fmt::format("mission {}", mission.spacecraft),
                               "two mission files describe this spacecraft",
                               "leave one out: the service takes one"));
      continue;
    }
    for (Check& check : check_settings(mission)) {
      checks.push_back(std::move(check));
    }
    checks.push_back(check_alignment(mission));
    if (mission.kind == SpacecraftKind::Spin || mission.field_to) {
      checks.push_back(check_orbit(mission, pass));
    }
    if (mission.field_to) {
      checks.push_back(check_field(mission, pass));
    }
    if (mission.ground_model || !mission.model_problem.empty()) {
      checks.push_back(check_model(mission, pass));
    }
  }
  return checks;
}

}  // namespace spindrift::doctor
