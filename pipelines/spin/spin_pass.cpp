#include "pipelines/spin/spin_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/axis_candidates.h"
#include "pipelines/spin/edge_use.h"
#include "pipelines/spin/geometry.h"
#include "pipelines/spin/model_allowance.h"
#include "pipelines/spin/time_span.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

// So many fixes must agree on an axis before it speaks for or against a candidate.
constexpr std::size_t kEstablishedFixes = 10;
// Beyond so many sigmas, and the model's limit, the axis is another one than before.
constexpr double kMovedSigmas = 5.0;
// Where beams cross the Earth well apart, an axis moves by three or four times the errors of the
// model; where both look across the same middle of it, by ten.
constexpr double kPoorLeverage = 6.0;

/// What the spherical horizon leaves out of an oblate Earth, as a covariance: the limb of each beam
/// anywhere between none and the whole of its displacement. Unlike the noise of the pulses it does
/// not shrink with the number of fixes.
/// @param shift What each error of the model moves the axis by, for every radian of it.
Eigen::Matrix2d horizon_error_rad2(const SpinConfig& config, double disc_rad,
                                   const Eigen::Matrix<double, 2, kModelErrors>& shift) {
  if (config.horizon.model == HorizonModel::Sphere) {
    return Eigen::Matrix2d::Zero();
  }
  const double limb_rad = oblateness_rad(disc_rad);
  const Eigen::Vector2d north = shift.col(NorthLimb);
  const Eigen::Vector2d south = shift.col(SouthLimb);
  return (north * north.transpose() + south * south.transpose()) * (limb_rad * limb_rad / 3.0);
}

/// The fix, with what the spherical horizon leaves out in its covariances.
SpinFix on_the_ellipsoid(const SpinConfig& config, double disc_rad, SpinFix fix) {
  const auto left_out_rad2 = [&](const Eigen::Vector3d& axis_icrf, const auto& shift_icrf) {
    return horizon_error_rad2(config, disc_rad, tangent_basis(axis_icrf).transpose() * shift_icrf);
  };
  fix.covariance_rad2 += left_out_rad2(fix.axis_icrf, fix.model_shift_icrf);
  for (std::size_t i = 0; i < fix.alternate_axes_icrf.size(); ++i) {
    fix.alternate_covariances_rad2[i] +=
        left_out_rad2(fix.alternate_axes_icrf[i], fix.alternate_model_shifts_icrf[i]);
  }
  return fix;
}

Eigen::Vector3d median_axis(const std::vector<Eigen::Vector3d>& axes) {
  Eigen::Vector3d median;
  for (Eigen::Index i = 0; i < 3; ++i) {
    std::vector<double> components(axes.size());
    std::transform(axes.begin(), axes.end(), components.begin(),
                   [i](const Eigen::Vector3d& axis) { return axis[i]; });
    const auto middle = components.begin() + static_cast<std::ptrdiff_t>(components.size() / 2);
    std::nth_element(components.begin(), middle, components.end());
    median[i] = *middle;
  }
  return median.normalized();
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

std::vector<Verdict> verdicts_on(const Revolution& revolution,
                                 const RevolutionMeasurements& measured) {
  std::vector<Verdict> verdicts;
  if (const auto& period = revolution.period_candidate) {
    verdicts.push_back(
        {.quantity = SpinQuantity::Period,
         .rejected_by = period->accepted ? std::nullopt : std::optional{Rejection::Period}});
  }
  for (const SpinQuantity quantity : kMeasuredAngles) {
    if (const auto value = value_of(measured, quantity)) {
      verdicts.push_back({.quantity = quantity, .rejected_by = value->rejected_by});
    }
  }
  return verdicts;
}

SpinMeasurement measurement_of(const Revolution& revolution, const RevolutionMeasurements& measured,
                               const Verdict& verdict) {
  SpinMeasurement product{.revolution = revolution.number,
                          .quantity = verdict.quantity,
                          .value = 0.0,
                          .sigma = 0.0,
                          .rejected_by = verdict.rejected_by};
  if (verdict.quantity == SpinQuantity::Period) {
    product.value = revolution.period_candidate->period_s;
    product.sigma = revolution.period_candidate->sigma_s;
  } else {
    const Measured value = *value_of(measured, verdict.quantity);
    product.value = value.value_rad;
    product.sigma = value.sigma_rad;
  }
  return product;
}

}  // namespace

std::vector<std::string> settings_without_effect(const SpinConfig& config) {
  if (config.horizon.model == HorizonModel::Sphere) {
    return {};
  }
  return {
      "spin.horizon.model = \"ellipsoid\": the estimators use it; fixes use the spherical horizon, "
      "and their sigma includes what that leaves out"};
}

SpinPass::SpinPass(const SpinConfig& config, Orbit orbit)
    : config_{config},
      surroundings_{std::move(orbit), config.horizon.co2_altitude_km},
      interference_{config.screening.interference_s},
      associator_{config},
      screening_{config.screening},
      recent_axes_{static_cast<std::size_t>(config.screening.window)},
      disambiguator_{config},
      mean_{config},
      trust_{static_cast<double>(config.screening.window)},
      sequential_{config} {}

SpinOutput SpinPass::push(const Pulse& pulse) {
  SpinOutput out;
  take(pulse, out);
  return out;
}

SpinOutput SpinPass::push(const CodedFrame& frame) {
  SpinOutput out;
  switch (frames_.add(frame)) {
    case FrameReorderWindow::Verdict::Held:
      for (const CodedFrame& due : frames_.release()) {
        take(due, out);
      }
      break;
    case FrameReorderWindow::Verdict::Late:
    case FrameReorderWindow::Verdict::OutOfTime:
      // As edges they are late or out of time as well, and are left out as such.
      for (const Pulse& edge : edges_of(frame)) {
        take(edge, out);
      }
      break;
    case FrameReorderWindow::Verdict::Duplicate:
      break;
  }
  return out;
}

SpinOutput SpinPass::finish() {
  SpinOutput out;
  const FrameReorderWindow::Rest frames = frames_.release_all();
  for (const std::vector<CodedFrame>& some : {frames.in_time, frames.out_of_time}) {
    for (const CodedFrame& frame : some) {
      take(frame, out);
    }
  }
  for (const Pulse& edge : std::exchange(of_next_turn_, {})) {
    take(edge, out);
  }
  const ReorderWindow::Rest rest = reorder_.release_all();
  sort_out(rest.in_time, out);
  associate(interference_.finish(), out);
  collect(associator_.finish(), out);
  if (!started_) {
    settle_first(out);
  }
  for (const Pulse& pulse : rest.out_of_time) {
    leave_out(pulse, Rejection::OutOfTime, out);
    say_once("pulses stamped far ahead of all others are left out: a sender's clock is wrong", out);
  }
  say_what_is_missing(out);
  return out;
}

/// Of those that the mission has.
std::string SpinPass::silent_channels() const {
  std::string silent;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    if (!heard_.at(i) && has_sensor(config_, channel)) {
      silent += fmt::format("{}{}", silent.empty() ? "" : ", ", name_of(channel));
    }
  }
  return silent;
}

/// Known for certain only at the end.
void SpinPass::say_what_is_missing(SpinOutput& out) const {
  if (!closed_any_ && left_over_any_) {
    out.notices.emplace_back("no spin period was found in the edges: no revolution, and no axis");
  }
  if (const std::string silent = silent_channels(); closed_any_ && !silent.empty()) {
    out.notices.push_back(fmt::format("no edge at all came from {}", silent));
  }
  for (const InterferingChannels& channels : associator_.interfering()) {
    out.notices.push_back(fmt::format(
        "{} and {} were too near to each other in {} revolutions from {} to {}: their edges there "
        "are left out",
        name_of(channels.one), name_of(channels.other), channels.revolutions,
        format_utc(channels.first), format_utc(channels.last)));
  }
  if (without_orbit_ > 1) {
    out.notices.push_back(fmt::format("orbit: {} revolutions outside it gave no axis, the last: {}",
                                      without_orbit_, last_without_orbit_));
  }
  say_what_the_axis_lacks(out);
}

void SpinPass::say_what_the_axis_lacks(SpinOutput& out) const {
  if (last_status_.empty() && last_case_ != 0) {
    out.notices.emplace_back(
        "the estimator 'sequential' never began: its fixes leave the axis, or a candidate for it, "
        "uncertain by more than 3 deg");
  }
  if (last_status_.starts_with("OK") && sequential_.model_leverage() > kPoorLeverage) {
    out.notices.push_back(
        fmt::format("poor leverage: errors of {:.2f} deg in mounting or limb move the axis by "
                    "{:.1f} deg; sigma "
                    "includes no more of them than the edges show",
                    kModelError_rad * 180.0 / std::numbers::pi,
                    sequential_.model_leverage() * kModelError_rad * 180.0 / std::numbers::pi));
  }
  if (last_case_ == 0 && without_fix_ > 1) {
    out.notices.push_back(fmt::format("no axis: {} revolutions gave no fix, the last: {}",
                                      without_fix_, last_without_fix_));
  }
  if (last_status_.starts_with("AMBIGUOUS")) {
    out.notices.push_back(
        fmt::format("the axis is ambiguous to the end{}: a prior in the mission "
                    "file would choose among the candidates",
                    what_is_missing(last_case_)));
  }
}

void SpinPass::take(const CodedFrame& frame, SpinOutput& out) {
  if (frame.period_s) {
    associator_.note_period(frame.t, *frame.period_s);
  }
  std::vector<Pulse> edges = std::exchange(of_next_turn_, edges_of(frame));
  const auto in_this_turn =
      std::partition_point(of_next_turn_.begin(), of_next_turn_.end(), [&](const Pulse& edge) {
        return !frame.period_s || edge.t < later_by_s(frame.t, *frame.period_s);
      });
  edges.insert(edges.end(), of_next_turn_.begin(), in_this_turn);
  of_next_turn_.erase(of_next_turn_.begin(), in_this_turn);
  std::sort(edges.begin(), edges.end());
  for (const Pulse& edge : edges) {
    take(edge, out);
  }
}

void SpinPass::take(const Pulse& pulse, SpinOutput& out) {
  heard_.at(index_of(pulse.channel)) = true;
  switch (reorder_.add(pulse)) {
    case ReorderWindow::Verdict::Held:
      sort_out(reorder_.release(), out);
      break;
    case ReorderWindow::Verdict::Late:
      leave_out(pulse, Rejection::Late, out);
      say_once("pulses arrive after their time was processed: they are stored and left out", out);
      break;
    case ReorderWindow::Verdict::OutOfTime:
      leave_out(pulse, Rejection::OutOfTime, out);
      break;
    case ReorderWindow::Verdict::Duplicate:
      break;  // The same edge once more: what becomes of it is said once.
  }
}

void SpinPass::leave_out(const Pulse& pulse, Rejection rejected_by, SpinOutput& out) {
  out.products.emplace_back(PulseUse{.pulse = pulse, .revolution = {}, .rejected_by = rejected_by});
}

void SpinPass::say_once(const std::string& notice, SpinOutput& out) {
  say_first(notice, notice, out);
}

/// The first notice of its kind.
void SpinPass::say_first(std::string_view kind, const std::string& notice, SpinOutput& out) {
  if (said_.emplace(kind).second) {
    out.notices.push_back(notice);
  }
}

void SpinPass::sort_out(const std::vector<Pulse>& in_time, SpinOutput& out) {
  for (const Pulse& pulse : in_time) {
    associate(interference_.push(pulse), out);
  }
}

void SpinPass::associate(const std::vector<InterferenceWindow::Judged>& pulses, SpinOutput& out) {
  for (const auto& [pulse, spoilt] : pulses) {
    collect(spoilt ? associator_.push_spoilt(pulse) : associator_.push(pulse), out);
  }
}

void SpinPass::collect(Association association, SpinOutput& out) {
  left_over_any_ = left_over_any_ || !association.left_over.empty();
  closed_any_ = closed_any_ || !association.closed.empty();
  std::move(association.left_over.begin(), association.left_over.end(),
            std::back_inserter(out.products));
  for (const InterferingChannels& channels : association.began_to_interfere) {
    out.notices.push_back(fmt::format(
        "{}: {} and {} come too near to each other (spin.screening.interference_s = {}): as long "
        "as they do, their edges are left out",
        format_utc(channels.first), name_of(channels.one), name_of(channels.other),
        config_.screening.interference_s));
  }
  for (const Revolution& revolution : association.closed) {
    consider(revolution, out);
  }
}

void SpinPass::consider(const Revolution& revolution, SpinOutput& out) {
  if (const auto& off_turns = revolution.count_sigma_turns) {
    out.notices.push_back(
        fmt::format("after a silence the count of revolutions is uncertain by about {:.1f}, from "
                    "revolution {} on",
                    *off_turns, revolution.number));
  }
  Candidate candidate{.revolution = revolution,
                      .measured = measure(config_, revolution),
                      .sightlines = {},
                      .residuals = {}};
  if (const auto sightlines = surroundings_.sightlines(candidate.measured, revolution.t_start)) {
    candidate.sightlines = *sightlines;
  } else {
    ++without_orbit_;
    last_without_orbit_ = sightlines.error().message;
    say_first(
        "orbit",
        fmt::format("orbit: {}; revolutions outside it give no axis", sightlines.error().message),
        out);
  }
  if (!started_) {
    first_.push_back(std::move(candidate));
    if (first_.size() >= kFirstRevolutions) {
      settle_first(out);
    }
    return;
  }
  if (const auto axis_icrf = recent_axes_.axis_icrf()) {
    predict(candidate, *axis_icrf);
  }
  settle(candidate, out);
}

void SpinPass::settle_first(SpinOutput& out) {
  started_ = true;
  std::vector<Eigen::Vector3d> axes_icrf;
  for (const Candidate& candidate : first_) {
    if (!candidate.sightlines) {
      continue;
    }
    const auto found = axis_candidates(config_, candidate.measured, *candidate.sightlines);
    if (found && found->told_apart) {
      axes_icrf.push_back(found->candidates.front().axis_icrf);
    }
  }
  if (!axes_icrf.empty()) {
    const Eigen::Vector3d axis_icrf = median_axis(axes_icrf);
    for (Candidate& candidate : first_) {
      predict(candidate, axis_icrf);
    }
  }
  // Beforehand, so that all of them judge the first.
  for (Candidate& candidate : first_) {
    screen(candidate);
    if (candidate.sightlines) {
      trust_.count(axis_candidates(config_, candidate.measured, *candidate.sightlines));
    }
  }
  for (Candidate& candidate : std::exchange(first_, {})) {
    settle(candidate, out);
  }
}

void SpinPass::predict(Candidate& candidate, const Eigen::Vector3d& axis_icrf) {
  if (candidate.sightlines) {
    candidate.residuals = residuals(config_, candidate.measured, *candidate.sightlines, axis_icrf);
    for (const Residual& residual : candidate.residuals) {
      screening_.add(residual);
    }
  }
}

void SpinPass::screen(Candidate& candidate) const {
  for (const Residual& residual : candidate.residuals) {
    if (!screening_.keeps(residual)) {
      reject(candidate.measured, residual.quantity, rejection_of(residual.quantity));
    }
  }
  if (!candidate.sightlines) {
    for (const SpinQuantity quantity : kMeasuredAngles) {
      reject(candidate.measured, quantity, Rejection::NoOrbit);
    }
  }
}

void SpinPass::settle(Candidate& candidate, SpinOutput& out) {
  screen(candidate);
  const Revolution& revolution = candidate.revolution;
  if (candidate.measured.t_sun1) {
    out.products.emplace_back(RevolutionProduct{.revolution = revolution.number,
                                                .t_sun1 = *candidate.measured.t_sun1,
                                                .period_s = revolution.period.period_s});
  }
  const std::vector<Verdict> verdicts = verdicts_on(revolution, candidate.measured);
  for (const Verdict& verdict : verdicts) {
    out.products.emplace_back(measurement_of(revolution, candidate.measured, verdict));
  }
  for (const PulseUse& use : edge_uses(config_, revolution, verdicts)) {
    out.products.emplace_back(use);
  }
  if (candidate.sightlines) {
    announce_axis(candidate, out);
  }
}

std::vector<SpinFix> SpinPass::find_fixes(const Candidate& candidate, SpinOutput& out) {
  const Revolution& revolution = candidate.revolution;
  const auto found = axis_candidates(config_, candidate.measured, *candidate.sightlines);
  trust_.count(found);
  if (!found) {
    // The measurements stand; this revolution alone gives no axis.
    ++without_fix_;
    last_without_fix_ = found.error().message;
    say_first("fix",
              fmt::format("revolution {} is the first that gives no fix: {}", revolution.number,
                          found.error().message),
              out);
    return {};
  }
  last_case_ = found->geometry_case;
  auto fixes = disambiguator_.settle(revolution.number, revolution.t_start, candidate.measured,
                                     *candidate.sightlines, *found, established_axis());
  for (SpinFix& fix : fixes) {
    fix.accepted = fix.accepted && trust_.deserved();
  }
  return fixes;
}

void SpinPass::say_why_not_accepted(const SpinFix& fix, SpinOutput& out) {
  if (!trust_.deserved()) {
    say_once(
        "the measurements of most revolutions contradict each other: no fix is accepted, as "
        "others may agree by accident; check the mission's mounting angles, azimuths and orbit",
        out);
  } else if (const auto side = disambiguator_.silent_where_seen()) {
    say_once(fmt::format("the {} beam, said to be healthy, is silent where the axis says it must "
                         "see the Earth: such fixes are not accepted; if the beam has failed, "
                         "say healthy = false",
                         *side == Side::North ? "north" : "south"),
             out);
  } else if (!fix.accepted && fix.resolution != Resolution::Ambiguous) {
    say_once(
        "measurements contradict each other, their fixes are not accepted: the length of the "
        "axis or the size of the Earth's disc comes out wrong; check the mission's mounting "
        "angles, azimuths and orbit",
        out);
  }
}

void SpinPass::announce_axis(const Candidate& candidate, SpinOutput& out) {
  const Revolution& revolution = candidate.revolution;
  const double disc_rad = candidate.sightlines->disc_rad;
  const std::vector<SpinFix> fixes = find_fixes(candidate, out);
  std::vector<SpinFix> announced;
  std::transform(fixes.begin(), fixes.end(), std::back_inserter(announced),
                 [&](const SpinFix& fix) { return on_the_ellipsoid(config_, disc_rad, fix); });
  std::optional<SpinEstimate> sequential;
  if (const auto sky = surroundings_.sky(revolution.t_start)) {
    sequential = sequential_.update(
        revolution, *sky, trust_.deserved() ? std::span{announced} : std::span<SpinFix>{});
    if (sequential_.prior_refuted() && config_.prior) {
      forget_prior(revolution.t_start, out);
    }
    if (sequential && (sequential_.restarts() > restarts_heeded_ ||
                       recent_fixes_left_the_mean_for(sequential->axis_icrf))) {
      start_again_where_moved(*sequential, out);
    }
  }
  for (SpinFix& fix : announced) {
    out.products.emplace_back(std::move(fix));
  }
  bool mean_moved = false;
  mean_.keep(revolution.number, candidate.measured, *candidate.sightlines);
  for (const SpinFix& fix : fixes) {
    say_why_not_accepted(fix, out);
    if (mean_.take(fix)) {
      recent_axes_.add(fix);
      mean_moved = true;
    }
  }
  if (mean_moved) {
    out.products.emplace_back(mean_.estimate(revolution));
  }
  if (sequential) {
    last_status_ = sequential->status;
    out.products.emplace_back(std::move(*sequential));
  }
}

/// What the prior chose is not of the axis that the edges show.
void SpinPass::forget_prior(TaiTime t, SpinOutput& out) {
  config_.prior.reset();
  begin_anew(t);
  out.notices.push_back(
      fmt::format("{}: the edges contradict the prior of the mission: the axis is another one, the "
                  "mean begins anew",
                  format_utc(t)));
}

void SpinPass::begin_anew(TaiTime t) {
  mean_.begin_anew(t);
  recent_axes_ = AxisWindow{static_cast<std::size_t>(config_.screening.window)};
  screening_ = ScreeningWindow{config_.screening};
  disambiguator_ = Disambiguator{config_};
}

/// They share what is wrong with the model, so that a difference is the axis's own.
bool SpinPass::recent_fixes_left_the_mean_for(const Eigen::Vector3d& axis_icrf) const {
  const auto recent_icrf = recent_axes_.axis_icrf();
  if (!recent_icrf || mean_.count() == 0) {
    return false;
  }
  const double apart_rad = angle_between_rad(*recent_icrf, mean_.axis_icrf());
  return apart_rad > kModelLimit_rad && angle_between_rad(*recent_icrf, axis_icrf) < apart_rad;
}

/// A restart of `sequential`, or recent fixes that lie elsewhere, raise the question; it may take
/// some revolutions until its axis is known so well that the answer is clear.
void SpinPass::start_again_where_moved(const SpinEstimate& sequential, SpinOutput& out) {
  if (mean_.count() == 0) {
    return;
  }
  const double apart_rad = angle_between_rad(mean_.axis_icrf(), sequential.axis_icrf);
  const double sigma_rad =
      std::sqrt(mean_.covariance_if_moved_rad2().trace() + sequential.covariance_rad2.trace());
  if (apart_rad <= std::hypot(kMovedSigmas * sigma_rad, kModelLimit_rad)) {
    return;
  }
  restarts_heeded_ = sequential_.restarts();
  begin_anew(sequential.t);
  out.notices.push_back(
      fmt::format("{}: the axis is {:.2f} deg from the mean so far: it has moved, or the mean was "
                  "wrong; the mean "
                  "begins anew",
                  format_utc(sequential.t), apart_rad * 180.0 / std::numbers::pi));
}

std::optional<KnownAxis> SpinPass::established_axis() const {
  if (mean_.count() < kEstablishedFixes) {
    return sequential_.settled_by_edges();
  }
  return KnownAxis{
      .axis_icrf = mean_.axis_icrf(),
      .sigma_rad = std::hypot(std::sqrt(mean_.covariance_rad2().trace()), kModelLimit_rad)};
}

}  // namespace spindrift
