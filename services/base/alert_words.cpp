#include "services/base/alert_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <variant>

#include "pipelines/core/shown.h"
#include "pipelines/observation/sensor_contradiction.h"
#include "pipelines/time/tai_time.h"
#include "pipelines/time/utc.h"
#include "services/base/duration.h"
#include "services/base/filled.h"

namespace spindrift {
namespace {

constexpr double kLong_s = 60.0;

struct Words {
  AlertCode code;
  std::string_view what;
  std::string_view to_do;
};

using enum AlertCode;
constexpr std::array<Words, kAlertCodes> kWords{{
    {LinkSilent, "no telemetry", "look at antenna, receiver and front-end"},
    {LinkLate, "telemetry behind the clock of this host",
     "look at the link, and at the clocks of front-end and host"},
    {LinkAhead, "telemetry ahead of the clock of this host",
     "look at the clocks of front-end and host"},
    {LinkGap, "samples missing of the last minute, by gaps in seq",
     "look at the link, and at the network between front-end and host"},
    {LinkRejected, "share of unreadable or impossible samples of the last minute",
     "look at rejected_input and at the front-end"},
    {LinkRepeated, "a new session brings what came before it",
     "nothing needs to be done: it is stored once"},
    {LinkRestarted, "sessions that the source began in the last minute",
     "nothing needs to be done if it was to be started again"},
    {LinkContradiction, "samples of the last minute that another source gives with other values",
     "look at the table contradiction; [sources] prefer names the one whose value counts"},
    {ServiceTwice, "another service publishes results of the spacecraft in this partition",
     "stop one of the two; `spindrift doctor` says who is on the bus"},
    {AlertsUndelivered, "the webhook does not take alerts",
     "look at its receiver, and at the log for what it answers"},
    {ChannelSilent, "nothing from {}", "look at sensor and telemetry link"},
    {SpinInterference, "edges of two channels spoil each other",
     "nothing needs to be done: both are left out while it lasts"},
    {SpinPeriod, "share of revolutions with an irrational period",
     "look at the edges of sun1 and at what was commanded"},
    {SpinRejection, "share of edges left out", "look at pulse_use.rejected_by"},
    {SpinAmbiguous, "the answer in force is AMBIGUOUS",
     "wait for the geometry to turn, or give [spin.prior]"},
    {SpinDoubtful, "the answer in force is DOUBTFUL",
     "check mounting angles, noise, horizon and orbit of the mission file"},
    {SpinSigma, "sigma of the answer in force", "wait, or look which channels give nothing"},
    {SpinDisagree, "two estimators apart, in sigmas of their difference",
     "use neither before one of them says why"},
    {SpinOffTarget, "spin axis away from its target", "check [spin.target] and the manoeuvre"},
    {SpinNutation, "half-angle of the nutation", "let it decay before the next manoeuvre"},
    {SpinRate, "spin rate away from its target", "check [spin.target] and the manoeuvre"},
    {SpinNoAnswer, "edges come, and no answer of them",
     "look at pulse_use.rejected_by, at notice, and which channels give nothing"},
    {AttitudeLost, "the answer in force is LOST", "do not use it; wait for the next accepted fix"},
    {AttitudeDoubtful, "the answer in force is DOUBTFUL",
     "do not act on it before its reasons are understood"},
    {AttitudeNoAnswer, "samples come, and no answer of them",
     "look at rejected_sample, and which sensors give nothing"},
    {AttitudeDiverged, "innovations of the filter outside what its sigma allows, by chi-square",
     "check noise, mounting and bias of the sensors in the mission file"},
    {SensorContradicts, "a sensor contradicts others beyond what the mission file allows",
     "check its mounting, signs, units and time tags in the mission file, or exclude it"},
    {SensorStuck, "a sensor repeats the same numbers, so that its samples are left out",
     "look at the sensor and at who sends it"},
    {ReconstructionLauncher, "attitude at separation away from the launcher's",
     "check [reconstruction.launcher] and the mounting of star tracker and sun sensor"},
    {ModelDeparture, "flight away from the ground model",
     "look at the channel, at what was commanded, and at the scenario of the model"},
    {ArchiveBacklog, "samples wait to be committed", "look at disk and load of this host"},
    {ArchiveWrite, "the archive does not store", "look at the log, and at the disk of the archive"},
    {ArchiveDisk, "free space at the archive", "make room"},
    {ArchiveLog, "somebody reads on, so that the archive's log grows",
     "end the program that reads the archive"},
    {ClockDisagree, "no source is in time by the clock of this host",
     "look at the clocks of front-end and host, unless what comes is recorded"},
    {ClockJump, "the clock of this host was stepped", "look at its time service"},
    {DataOutdated, "what the service needs ends", "get it anew"},
}};
static_assert(are_by_code(kWords));

/// Words for a contradiction where nothing tells which of two sensors is wrong.
constexpr Words kNoCulprit{
    SensorContradicts,
    "two sensors contradict each other beyond what the mission file allows, and nothing tells "
    "which is wrong",
    "check mounting, signs, units and time tags of both in the mission file"};

/// Words for an attitude that the lost gate declares lost.
constexpr Words kLostGate{
    AttitudeLost,
    "the lost gate is open: the measured field is away from that of the commanded attitude",
    "stop control until the attitude is found again"};

/// Returns the value of what else is known by a name; null if there is none.
const NamedValue::Value* known(const Evidence& evidence, std::string_view name) {
  const auto found = std::find_if(evidence.more.begin(), evidence.more.end(),
                                  [&](const NamedValue& one) { return one.name == name; });
  return found != evidence.more.end() ? &found->value : nullptr;
}

const Words& words_for(AlertCode code, std::string_view about) {
  return code == SensorContradicts && about == kUnknownCulprit
             ? kNoCulprit
             : kWords.at(static_cast<std::size_t>(code));
}

/// Data of limited validity that the service needs.
struct Ending {
  std::string_view about;
  std::string_view what;
  std::string_view to_do;
};
constexpr std::array<Ending, 3> kEndings{{
    {"orbit", "the orbit", "get the next ephemeris"},
    {"leap_seconds", "the table of leap seconds", "install a newer tzdata"},
    {"field_coefficients", "the model of the Earth's field",
     "install a program with the next generation of it"},
}};

/// Returns null for a condition of any other kind.
const Ending* ending_of(AlertCode code, std::string_view about) {
  const auto* const found = std::find_if(kEndings.begin(), kEndings.end(),
                                         [&](const Ending& one) { return one.about == about; });
  return code == DataOutdated && found != kEndings.end() ? found : nullptr;
}

/// Returns three digits, or of a minute and more a duration.
std::string digits_of(double value, std::string_view unit) {
  return unit == "s" && value >= kLong_s ? duration_text(value) : fmt::format("{:.3g}", value);
}

/// Returns what the alert is about, with the name of the thing if it is about one.
std::string what_of(AlertCode code, std::string_view about) {
  const Words& words = words_for(code, about);
  const std::string_view what = words.what;
  const std::string thing = shown(std::string{about});
  return what.find("{}") != std::string_view::npos ? fmt::format(fmt::runtime(what), thing)
         : about.empty() || &words == &kNoCulprit  ? std::string{what}
                                                   : fmt::format("{} ({})", what, thing);
}

/// Returns how many samples of a gate's window were hits; empty of any other condition.
std::string window_text(const Evidence& evidence) {
  const auto* const hits = known(evidence, "hits");
  const auto* const window = known(evidence, "window");
  return hits != nullptr && window != nullptr
             ? fmt::format(" in {} of {} samples", std::get<std::int64_t>(*hits),
                           std::get<std::int64_t>(*window))
             : std::string{};
}

std::string value_text(const ConditionChange& change) {
  const Evidence& evidence = change.evidence;
  if (const Ending* const ending = ending_of(change.code, change.about)) {
    const bool is_over = evidence.value < 0.0;
    return fmt::format(": {} {}{}{}", ending->what, is_over ? "ended " : "ends in ",
                       duration_text(std::abs(evidence.value) * kHour_s), is_over ? " ago" : "");
  }
  if (evidence.limit <= 0.0 || evidence.is_presence) {
    return {};  // The alert is raised by mere presence, so the value says nothing.
  }
  const std::string sigma =
      evidence.sigma ? fmt::format(" (sigma {:.3g})", *evidence.sigma) : std::string{};
  const std::string worst = evidence.worst && *evidence.worst != evidence.value
                                ? ", worst " + digits_of(*evidence.worst, evidence.unit)
                                : std::string{};
  const bool has_unit = evidence.unit != "s" || evidence.value < kLong_s;
  return fmt::format("{}{}{}{}{}, limit {}{}", change.code == ChannelSilent ? " for " : ": ",
                     digits_of(evidence.value, evidence.unit),
                     has_unit ? fmt::format(" {}", evidence.unit) : "", sigma, worst,
                     digits_of(evidence.limit, evidence.unit), window_text(evidence));
}

bool is_by_gate(const ConditionChange& change) {
  return change.code == AttitudeLost && known(change.evidence, "gate") != nullptr;
}

std::string what_of(const ConditionChange& change) {
  const bool names_it = ending_of(change.code, change.about) == nullptr;
  return is_by_gate(change) ? std::string{kLostGate.what}
                            : what_of(change.code, names_it ? change.about : "");
}

std::string_view what_to_do(const ConditionChange& change) {
  const Ending* const ending = ending_of(change.code, change.about);
  return ending != nullptr    ? ending->to_do
         : is_by_gate(change) ? kLostGate.to_do
                              : words_for(change.code, change.about).to_do;
}

}  // namespace

std::string sentence_of(const ConditionChange& change, std::int64_t count) {
  if (change.change == Change::Cleared) {
    return fmt::format("over at {}", format_utc(change.t));
  }
  const std::string who = change.who.empty() ? "" : fmt::format(" ({})", shown(change.who));
  // The value of a departure was measured at its first instant.
  const TaiTime t = change.code == ModelDeparture ? change.evidence.since : change.t;
  const std::string since = change.change == Change::Renewed
                                ? fmt::format(", since {}", format_utc(change.evidence.since))
                                : std::string{};
  const std::string often = count > 1 ? fmt::format(", {} times so far", count) : std::string{};
  return fmt::format("{}{}{} at {}{}{}: {}", what_of(change), who, value_text(change),
                     format_utc(t), since, often, what_to_do(change));
}

std::string words_of(const std::string& key) {
  const auto code = code_of(key);
  if (!code) {
    return key;
  }
  const std::string_view about = about_of(key);
  const Ending* const ending = ending_of(*code, about);
  return ending != nullptr ? fmt::format("{} is old", ending->what) : what_of(*code, about);
}

std::string evidence_json(const Evidence& evidence, std::string_view config_sha256,
                          std::int64_t count) {
  nlohmann::ordered_json json{{"value", evidence.value},
                              {"limit", evidence.limit},
                              {"unit", evidence.unit},
                              {"since_tai_ns", tai_ns(evidence.since)},
                              {"samples", {tai_ns(evidence.since), tai_ns(evidence.last)}},
                              {"config_sha256", config_sha256}};
  json["worst"] = evidence.worst.value_or(evidence.value);
  json["count"] = count;
  if (evidence.sigma) {
    json["sigma"] = *evidence.sigma;
  }
  for (const NamedValue& one : evidence.more) {
    std::visit([&](const auto& value) { json[one.name] = value; }, one.value);
  }
  if (!evidence.sources.empty()) {
    json["sources"] = evidence.sources;
  }
  return json.dump();
}

}  // namespace spindrift
