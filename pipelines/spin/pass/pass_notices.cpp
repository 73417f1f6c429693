#include "pipelines/spin/pass/pass_notices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/association/period_search.h"
#include "pipelines/spin/measurement/edge_use.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

constexpr double kPriorSigmas = 5.0;
// Of a pass of few turns a large share is left out before its spin period is found.
constexpr std::int64_t kFewestToJudge = 100;
// What is said of it, is said once.
constexpr std::string_view kPrior = "prior";

double degrees(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

/// It is the edges themselves, or what the mission says of them, that does not fit.
bool is_of_the_edge(Rejection rejection) {
  return rejection != Rejection::Late && rejection != Rejection::OutOfTime &&
         rejection != Rejection::Interference && rejection != Rejection::NoSensor &&
         rejection != Rejection::NoOrbit;
}

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

void PassNotices::used(std::span<const SpinProduct> products) {
  for (const SpinProduct& product : products) {
    if (const auto* use = std::get_if<PulseUse>(&product)) {
      ++edges_;
      if (use->rejected_by) {
        ++left_out_[*use->rejected_by];
      }
    }
  }
}

void PassNotices::edge_came_late() {
  say_once("pulses arrive after their time was processed: they are stored and left out");
}

void PassNotices::edge_out_of_time() {
  say_once(
      "pulses stamped far from the times of all others are left out: a sender's clock is wrong");
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

void PassNotices::has_fix(const SpinFix& fix, std::optional<PriorVerdict> prior) {
  last_case_ = fix.geometry_case;
  prior_verdict_ = prior;
  if (fix.grazing) {
    ++grazing_;
  } else if (fix.resolution == Resolution::Ambiguous) {
    ++ambiguous_;
  } else if (!fix.accepted) {
    ++otherwise_not_accepted_;
  }
}

void PassNotices::settled_by_dispersion(TaiTime t, const SteadyBranch& branch) {
  const RaDec axis = ra_dec_of(branch.axis.axis_icrf);
  say(fmt::format(
      "{}: the dispersion settles on the axis near ra {:.2f} dec {:.2f} deg: over {:.0f} "
      "fixes its candidates stay where they are and the others drift, ratio of the "
      "scatters {:.1f} ({})",
      format_utc(t), degrees(axis.ra_rad), degrees(axis.dec_rad), branch.axis.count,
      branch.scatter_ratio,
      branch.log_likelihood_ratio
          ? fmt::format("likelihood ratio e^{:.0f}", *branch.log_likelihood_ratio)
          : "F-test"));
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
  prior_contradicted_ = true;
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
    say_first(kPrior,
              fmt::format("{}: the axis is {:.1f} deg from the prior of the mission "
                          "(spin.prior), {:.0f} times the sigma of both: the edges decide "
                          "without it",
                          format_utc(estimate.t), degrees(apart_rad), apart_rad / sigma_rad));
  }
}

void PassNotices::axis_moved(TaiTime t, double apart_rad) {
  say(
      fmt::format("{}: the axis is {:.2f} deg from the mean so far: it has moved, or the mean was "
                  "wrong; the mean begins anew",
                  format_utc(t), degrees(apart_rad)));
}

std::string PassNotices::channels_where(bool heard, bool described) const {
  std::string channels;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    if (heard_.at(i) == heard && has_sensor(config_, channel) == described) {
      channels += fmt::format("{}{}", channels.empty() ? "" : ", ", name_of(channel));
    }
  }
  return channels;
}

void PassNotices::pass_ended(std::span<const InterferingChannels> interfering,
                             const SequentialEstimator& sequential) {
  if (!closed_any_ && left_over_any_) {
    say(
        fmt::format("no spin period was found in the edges, of rates from {} to {} rpm: no "
                    "revolution, and no axis",
                    kSlowestSearched_rpm, kFastestSearched_rpm));
  }
  if (closed_any_) {
    say_what_was_left_out();
  }
  if (const std::string silent = channels_where(false, true); closed_any_ && !silent.empty()) {
    say(fmt::format("no edge at all came from {}", silent));
  }
  if (const std::string unknown = channels_where(true, false); !unknown.empty()) {
    say(fmt::format(
        "the mission describes no sensor for {}: their edges are left out; a beam needs "
        "[spin.ir.north] or [spin.ir.south]",
        unknown));
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

void PassNotices::say_what_was_left_out() {
  std::erase_if(left_out_, [](const auto& of_kind) { return !is_of_the_edge(of_kind.first); });
  std::int64_t all = 0;
  for (const auto& [rejection, edges] : left_out_) {
    all += edges;
  }
  if (edges_ < kFewestToJudge || 2 * all <= edges_) {
    return;
  }
  const auto most =
      std::max_element(left_out_.begin(), left_out_.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  say(fmt::format(
      "{:.0f} % of all edges do not fit and are left out, most as '{}': the count of "
      "revolutions, and what is made of the others, may be wrong",
      100.0 * static_cast<double>(all) / static_cast<double>(edges_), name_of(most->first)));
}

/// It takes fixes that are accepted and do not graze.
void PassNotices::say_why_no_mean() {
  if (mean_began_ || last_case_ == 0) {
    return;
  }
  std::string why;
  const auto add = [&](std::int64_t fixes, std::string_view what) {
    if (fixes > 0) {
      why += fmt::format("{}{} {}", why.empty() ? "" : ", ", fixes, what);
    }
  };
  add(grazing_, "graze (their candidates come together within the noise)");
  add(ambiguous_, "are ambiguous");
  add(otherwise_not_accepted_, "are not accepted");
  say(fmt::format("the estimator 'mean' never began: of {} fixes, {}",
                  grazing_ + ambiguous_ + otherwise_not_accepted_, why));
}

std::string PassNotices::why_ambiguous() const {
  if (last_status_.ends_with("fixes graze")) {
    return fmt::format(
        "nearly all fixes graze: the true axis may be missing among their candidates, so that {} "
        "settle "
        "it",
        config_.prior ? "the prior of the mission (spin.prior) does not" : "no prior would");
  }
  if (!config_.prior) {
    return "a prior in the mission file would choose among the candidates";
  }
  if (prior_contradicted_) {
    return "the edges contradict the prior of the mission (spin.prior)";
  }
  if (prior_verdict_ == PriorVerdict::FarFromAll) {
    return "the prior of the mission (spin.prior) does not settle it: no candidate is within three "
           "sigmas of it";
  }
  if (prior_verdict_ == PriorVerdict::NearSeveral) {
    return fmt::format(
        "the prior of the mission (spin.prior) does not settle it: within its sigma of {:g} deg, "
        "several candidates are equally near to it",
        degrees(config_.prior->sigma_rad));
  }
  return "the edges do not bear out the candidate that the prior of the mission (spin.prior) "
         "chooses";
}

void PassNotices::say_what_the_axis_lacks(const SequentialEstimator& sequential) {
  if (last_status_.empty() && last_case_ != 0) {
    say("the estimator 'sequential' never began: its fixes leave the axis, or a candidate for it, "
        "uncertain by more than 3 deg");
  }
  if (last_status_.starts_with("OK") &&
      sequential.model_leverage() > SequentialEstimator::kPoorLeverage) {
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
  say_why_no_mean();
  if (last_status_.starts_with("AMBIGUOUS")) {
    say(fmt::format("the axis is ambiguous to the end{}: {}", what_is_missing(last_case_),
                    why_ambiguous()));
  }
}

}  // namespace spindrift
