#include "pipelines/spin/pass_notices.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/edge_use.h"
#include "pipelines/spin/model_allowance.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

// Where beams cross the Earth well apart, an axis moves by three or four times the errors of the
// model; where both look across the same middle of it, by ten.
constexpr double kPoorLeverage = 6.0;
constexpr double kPriorSigmas = 5.0;
// What is said of it, is said once.
constexpr std::string_view kPrior = "prior";

/// Why the fixes of that case leave several candidates.
std::string_view what_is_missing(int geometry_case) {
  switch (geometry_case) {
    case 4:
      return ", for want of good sun2 edges";
    case 5:
    case 6:
      return ", for want of good sun edges and of one beam's chords";
    case 7:
      return ", for want of good sun1 edges";
    default:
      return "";
  }
}

}  // namespace

/// The first notice of its kind.
void PassNotices::say_first(std::string_view kind, const std::string& notice) {
  if (said_.emplace(kind).second) {
    say(notice);
  }
}

void PassNotices::edge_came_late() {
  say_once("pulses arrive after their time was processed: they are stored and left out");
}

void PassNotices::edge_out_of_time() {
  say_once("pulses stamped far ahead of all others are left out: a sender's clock is wrong");
}

void PassNotices::associated(const Association& association) {
  left_over_any_ = left_over_any_ || !association.left_over.empty();
  closed_any_ = closed_any_ || !association.closed.empty();
  for (const InterferingChannels& channels : association.began_to_interfere) {
    say(
        fmt::format("{}: {} and {} come too near to each other (spin.screening.interference_s = "
                    "{}): as long as they do, their edges are left out",
                    format_utc(channels.first), name_of(channels.one), name_of(channels.other),
                    config_.screening.interference_s));
  }
}

void PassNotices::counted_on(const Revolution& revolution) {
  if (const auto& off_turns = revolution.count_sigma_turns) {
    say(
        fmt::format("after a silence the count of revolutions is uncertain by about {:.1f}, from "
                    "revolution {} on",
                    *off_turns, revolution.number));
  }
}

void PassNotices::outside_orbit(const Error& error) {
  ++outside_orbit_;
  last_outside_orbit_ = error.message;
  say_first("orbit", fmt::format("orbit: {}; revolutions outside it give no axis", error.message));
}

void PassNotices::without_fix(std::int64_t revolution, const Error& error) {
  ++without_fix_;
  last_without_fix_ = error.message;
  say_first("fix", fmt::format("revolution {} is the first that gives no fix: {}", revolution,
                               error.message));
}

void PassNotices::most_contradict_themselves() {
  say_once(
      "the measurements of most revolutions contradict each other: no fix is accepted, as others "
      "may agree by accident; check the mission's mounting angles, azimuths and orbit");
}

void PassNotices::silent_where_it_must_see(Side side) {
  say_once(
      fmt::format("the {} beam, said to be healthy, is silent where the axis says it must see the "
                  "Earth: such fixes are not accepted; if the beam has failed, say healthy = false",
                  side == Side::North ? "north" : "south"));
}

void PassNotices::fix_contradicts_itself() {
  say_once(
      "measurements contradict each other, their fixes are not accepted: the length of the axis or "
      "the size of the Earth's disc comes out wrong; check the mission's mounting angles, azimuths "
      "and orbit");
}

/// What the prior chose is not of the axis that the edges show.
void PassNotices::prior_contradicted(TaiTime t) {
  say_first(kPrior, fmt::format("{}: the edges contradict the prior of the mission: the axis is "
                                "another one, the mean begins anew",
                                format_utc(t)));
}

/// A prior that has nothing to choose may be wrong as well.
void PassNotices::estimated(const SpinEstimate& estimate) {
  last_status_ = estimate.status;
  if (!config_.prior || !estimate.status.starts_with("OK")) {
    return;
  }
  const double apart_rad = angle_between_rad(config_.prior->axis_icrf, estimate.axis_icrf);
  const double sigma_rad =
      std::hypot(config_.prior->sigma_rad, std::sqrt(estimate.covariance_rad2.trace()));
  if (apart_rad > std::hypot(kPriorSigmas * sigma_rad, kModelLimit_rad)) {
    say_first(kPrior, fmt::format("{}: the axis is {:.1f} deg from the prior of the mission "
                                  "(spin.prior), {:.0f} times the sigma of both: the edges decide "
                                  "without it",
                                  format_utc(estimate.t), apart_rad * 180.0 / std::numbers::pi,
                                  apart_rad / sigma_rad));
  }
}

void PassNotices::axis_moved(TaiTime t, double apart_rad) {
  say(
      fmt::format("{}: the axis is {:.2f} deg from the mean so far: it has moved, or the mean was "
                  "wrong; the mean begins anew",
                  format_utc(t), apart_rad * 180.0 / std::numbers::pi));
}

/// Of those that the mission has.
std::string PassNotices::silent_channels() const {
  std::string silent;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    if (!heard_.at(i) && has_sensor(config_, channel)) {
      silent += fmt::format("{}{}", silent.empty() ? "" : ", ", name_of(channel));
    }
  }
  return silent;
}

void PassNotices::pass_ended(std::span<const InterferingChannels> interfering,
                             const SequentialEstimator& sequential) {
  if (!closed_any_ && left_over_any_) {
    say("no spin period was found in the edges: no revolution, and no axis");
  }
  if (const std::string silent = silent_channels(); closed_any_ && !silent.empty()) {
    say(fmt::format("no edge at all came from {}", silent));
  }
  for (const InterferingChannels& channels : interfering) {
    if (channels.revolutions < kFewestInterfering) {
      continue;
    }
    say(fmt::format(
        "{} and {} were too near to each other in {} revolutions from {} to {}: their edges there "
        "are left out",
        name_of(channels.one), name_of(channels.other), channels.revolutions,
        format_utc(channels.first), format_utc(channels.last)));
  }
  if (outside_orbit_ > 1) {
    say(fmt::format("orbit: {} revolutions outside it gave no axis, the last: {}", outside_orbit_,
                    last_outside_orbit_));
  }
  say_what_the_axis_lacks(sequential);
}

void PassNotices::say_what_the_axis_lacks(const SequentialEstimator& sequential) {
  if (last_status_.empty() && last_case_ != 0) {
    say("the estimator 'sequential' never began: its fixes leave the axis, or a candidate for it, "
        "uncertain by more than 3 deg");
  }
  if (last_status_.starts_with("OK") && sequential.model_leverage() > kPoorLeverage) {
    constexpr double kModelError_deg = kModelError_rad * 180.0 / std::numbers::pi;
    say(
        fmt::format("poor leverage: errors of {:.2f} deg in mounting or limb move the axis by "
                    "{:.1f} deg; sigma includes no more of them than the edges show",
                    kModelError_deg, sequential.model_leverage() * kModelError_deg));
  }
  if (last_case_ == 0 && without_fix_ > 1) {
    say(fmt::format("no axis: {} revolutions gave no fix, the last: {}", without_fix_,
                    last_without_fix_));
  }
  if (last_status_.starts_with("AMBIGUOUS")) {
    say(
        fmt::format("the axis is ambiguous to the end{}: a prior in the mission file would choose "
                    "among the candidates",
                    what_is_missing(last_case_)));
  }
}

}  // namespace spindrift
