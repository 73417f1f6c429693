#include "pipelines/spin/sequential/sequential.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/convergence.h"
#include "pipelines/spin/types/model_allowance.h"

namespace spindrift {
namespace {

constexpr std::size_t kMostHypotheses = 8;
// After this many near-tangent fixes and no other, better ones are not expected.
constexpr int kFewestNearTangent = 20;
constexpr double kRecentFixes = 50.0;  // Averaging length of the near-tangent share.
constexpr double kNearlyAll = 0.8;
// The mean squared innovation of `recent` edges, 1 if all is well, tests the stated noise. From a
// gated share of a fifth on, gated edges count as noise.
constexpr RecordRules kEdgeRules{
    .recent = 60.0, .fewest_freedoms = 15.0, .most_freedoms = 300.0, .noise_from_share = 0.2};

/// The rate is an average over the last seconds, for as long as its error takes to build up the
/// phase error. On a time grid the grid error adds at both ends.
double rate_sigma_rad_s(const SpinFilter& filter, const PulseNoise& noise) {
  const double ends_rad = filter.rate_rad_s() * std::numbers::sqrt2 * grid_sigma_s(noise);
  return filter.rate_sigma_rad_s() * std::hypot(1.0, ends_rad / filter.phase_sigma_rad());
}

}  // namespace

SequentialEstimator::SequentialEstimator(SpinConfig config)
    : config_{std::move(config)},
      alignment_root_{root_of(config_.alignment)},
      near_tangent_starts_{kFewestNearTangent},
      near_tangent_share_{kRecentFixes},
      ledger_{kEdgeRules} {}

std::optional<SpinEstimate> SequentialEstimator::update(const Revolution& revolution,
                                                        const Sky& sky,
                                                        std::span<const SpinFix> settled) {
  bool began = false;
  for (const SpinFix& fix : settled) {
    began = apply_fix(fix, revolution, sky) || began;
  }
  if (hypotheses_.empty()) {
    revolutions_before_start_ += settled.empty() ? 0 : 1;
    return std::nullopt;
  }
  if (config_.prior && !prior_refuted_ && !hypotheses_.settled()) {
    hypotheses_.prefer_near(*config_.prior);
  }
  if (!began) {
    work_in(revolution, sky);
  }
  const SpinFilter& best = hypotheses_.published().filter;
  return SpinEstimate{.t = revolution.t_start,
                      .estimator = SpinEstimator::Sequential,
                      .axis_icrf = best.axis_icrf(),
                      .covariance_rad2 = covariance_rad2(),
                      .spin_rate_rad_s = best.rate_rad_s(),
                      .spin_rate_sigma_rad_s = std::hypot(
                          rate_sigma_rad_s(best, config_.noise) * std::sqrt(verdict_.excess_noise),
                          std::sqrt(best.rate_alignment_rad2_s2())),
                      .assessment = assess(),
                      .alignment_rad2 = alignment_rad2(),
                      .shift_icrf = shift_icrf()};
}

/// @return True when filters began here.
bool SequentialEstimator::apply_fix(const SpinFix& fix, const Revolution& revolution,
                                    const Sky& sky) {
  note_near_tangent(fix);
  if (start_confirmation_.unconfirmed()) {
    const SpinFilter& filter = hypotheses_.published().filter;
    start_confirmation_.add_fix(
        fix, {.axis_icrf = filter.axis_icrf(), .covariance_rad2 = filter.total_covariance_rad2()});
  }
  StartingPoints* const starts = starting_points_for(fix);
  const auto said = starts != nullptr ? starts->add(candidates_of(fix)) : std::nullopt;
  if (!said) {
    return false;
  }
  // Starts afresh, because a common error of several fixes does not average out.
  starts->forget();
  if (!hypotheses_.empty() && !counts_as_near_tangent(fix)) {
    contradiction_.count_fix(hypotheses_, *said);
    hypotheses_.count_fix(*said);
  }
  if (superseded_by(fix)) {
    return begin(fix, said->points, revolution, sky);
  }
  if (fix.accepted) {
    select_hypothesis(fix, said->points.front());
  }
  if (leaves_open(fix)) {
    join(said->points, revolution, sky);
  }
  return false;
}

void SequentialEstimator::note_near_tangent(const SpinFix& fix) {
  near_tangent_share_.add(fix.near_tangent ? 1.0 : 0.0);
}

/// If nearly all fixes are near-tangent, noise keeps some from it, and these are no better.
bool SequentialEstimator::counts_as_near_tangent(const SpinFix& fix) const {
  return fix.near_tangent || (leaves_open(fix) && near_tangent_share_.mean() > kNearlyAll);
}

/// Keeps settled and open fixes apart: a settled fix near a branch made only of alternates does not
/// confirm it. Near-tangent fixes are ignored once there are others.
StartingPoints* SequentialEstimator::starting_points_for(const SpinFix& fix) {
  if (counts_as_near_tangent(fix)) {
    const bool no_others = hypotheses_.empty() || hypotheses_.provisional();
    return leaves_open(fix) && no_others ? &near_tangent_starts_ : nullptr;
  }
  if (leaves_open(fix)) {
    return &open_starts_;
  }
  return fix.accepted ? &settled_starts_ : nullptr;
}

/// Only an accepted fix may restart the filter, or any fix while all fixes are near-tangent.
bool SequentialEstimator::superseded_by(const SpinFix& fix) const {
  if (hypotheses_.empty()) {
    return true;
  }
  if (hypotheses_.provisional()) {
    return !counts_as_near_tangent(fix) || most_left_out();
  }
  return fix.accepted && (most_left_out() || fixes_contradict());
}

bool SequentialEstimator::fixes_contradict() const {
  return contradiction_.stands(
      hypotheses_, verdict_.excess_noise > 1.0 || ledger_.mostly_left_out().has_value());
}

/// Starts filters at all points, since without one of them the true axis may be missing.
bool SequentialEstimator::begin(const SpinFix& fix, std::span<const StartingPoint> points,
                                const Revolution& revolution, const Sky& sky) {
  Hypotheses started{counts_as_near_tangent(fix)};
  for (const StartingPoint& point : points) {
    if (!started.try_start(point, config_, revolution, sky)) {
      return false;
    }
  }
  if (!hypotheses_.empty() && !hypotheses_.provisional()) {
    ++restarts_;
    restarted_ = most_left_out() ? ReasonCode::RestartedGated : ReasonCode::RestartedByFixes;
  }
  hypotheses_ = std::move(started);
  start_confirmation_.begin(points.front());
  if (fix.accepted) {
    select_hypothesis(fix, points.front());
  }
  noise_at_restart_ = verdict_.excess_noise;
  ledger_.restart();
  evidence_.fade();
  test_model_and_noise();
  contradiction_ = {};
  settled_starts_.forget();
  open_starts_.forget();
  near_tangent_starts_.forget();
  untracked_.forget();
  return true;
}

void SequentialEstimator::select_hypothesis(const SpinFix& fix, const StartingPoint& axis) {
  if (hypotheses_.settled()) {
    return;
  }
  if (fix.resolution != Resolution::Prior) {
    hypotheses_.settle_at(axis);
  } else if (!prior_refuted_) {
    hypotheses_.prefer_at(axis);
  }
}

/// Adds filters where the fixes together have their branches, because false candidates move and are
/// told from the true one by it. Settled axes are reopened only if fixes contradict them.
void SequentialEstimator::join(std::span<const StartingPoint> points, const Revolution& revolution,
                               const Sky& sky) {
  if ((hypotheses_.settled() || hypotheses_.closed()) && !fixes_contradict()) {
    return;
  }
  std::vector<StartingPoint> unfollowed;
  std::copy_if(points.begin(), points.end(), std::back_inserter(unfollowed),
               [&](const StartingPoint& point) { return hypotheses_.contradicted_by(point); });
  if (const auto known = untracked_.add(unfollowed)) {
    for (const StartingPoint& point : known->points) {
      if (hypotheses_.count() < kMostHypotheses) {
        hypotheses_.try_start(point, config_, revolution, sky);
      }
    }
  }
}

ChannelNoise SequentialEstimator::gate_noise() const {
  ChannelNoise noise{};
  const double of_all = std::min(verdict_.excess_noise, noise_at_restart_);
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    noise.at(i) = std::max(ledger_.oscillation(source_of(static_cast<PulseChannel>(i))), of_all);
  }
  return noise;
}

void SequentialEstimator::work_in(const Revolution& revolution, const Sky& sky) {
  if (hypotheses_.work_in(config_, revolution, sky, gate_noise())) {
    prior_refuted_ = true;
    ++restarts_;
  }
  const Hypothesis& published = hypotheses_.published();
  const std::span<const Observation> said = published.said.edges();
  ledger_.add(published.said.independent());
  evidence_.add(published.said.errors,
                static_cast<double>(std::count_if(
                    said.begin(), said.end(), [](const auto& edge) { return !edge.rejected_by; })));
  test_model_and_noise();
  // The first edges pull the filter away from its start, so their innovations do not count.
  const auto edges = static_cast<double>(said.size());
  if (published.edges - edges < kFewestEdgesToFit && published.edges >= kFewestEdgesToFit) {
    // This start noise is still significant for the fewest edges, but soon not if later ones are
    // good.
    ledger_.discard_transient(4.0);
    evidence_ = {};
  }
}

void SequentialEstimator::test_model_and_noise() {
  verdict_ = evidence_.test(ledger_.all().excess_noise(),
                            considered_prior(config_.noise, config_.alignment));
}

/// Returns whether most edges are gated, which shows that the axis is wrong.
bool SequentialEstimator::most_left_out() const {
  // Share of gated edges beyond which the axis is lost.
  return ledger_.all().recent_share_left_out() > 0.5;
}

Eigen::Matrix2d SequentialEstimator::covariance_rad2() const {
  if (most_left_out()) {
    return anywhere_covariance_rad2();
  }
  const SpinFilter& filter = hypotheses_.published().filter;
  const Eigen::Matrix<double, 2, kModelErrors> moved = filter.axis_of_errors();
  const Eigen::Matrix2d shown_rad2 = filter.axis_covariance_rad2() * verdict_.excess_noise +
                                     moved * verdict_.errors_rad2 * moved.transpose();
  return shown_rad2 + filter.considered_rad2(considered_prior(config_.noise, config_.alignment)) +
         grazing_rad2();
}

/// Where all fixes graze the limb, a filter that began to one side of the axis may stay there, and
/// its edges fit. Its axis is then known no better than the prior that chose it, and no better than
/// the two agree.
Eigen::Matrix2d SequentialEstimator::grazing_rad2() const {
  if (!config_.prior || !hypotheses_.provisional() || !hypotheses_.prior_stands()) {
    return Eigen::Matrix2d::Zero();
  }
  const double off_rad = angle_between_rad(config_.prior->axis_icrf, axis_icrf());
  const double sigma_rad = std::hypot(config_.prior->sigma_rad, off_rad);
  return 0.5 * sigma_rad * sigma_rad * Eigen::Matrix2d::Identity();
}

Eigen::Matrix2d SequentialEstimator::alignment_rad2() const {
  return most_left_out()
             ? Eigen::Matrix2d{Eigen::Matrix2d::Zero()}
             : hypotheses_.published().filter.considered_rad2(considered_prior(config_.alignment));
}

double SequentialEstimator::model_leverage() const {
  return hypotheses_.published().filter.axis_of_errors().norm();
}

std::optional<KnownAxis> SequentialEstimator::settled_by_edges() const {
  if (!hypotheses_.settled_by_edges() || most_left_out() || model_contradicts()) {
    return std::nullopt;
  }
  return KnownAxis{.axis_icrf = hypotheses_.published().filter.axis_icrf(),
                   .sigma_rad = std::hypot(std::sqrt(covariance_rad2().trace()), kModelLimit_rad)};
}

/// No sensor is misplaced this far, so the axis is wrong, however well the rest fits.
bool SequentialEstimator::model_contradicts() const {
  return verdict_.beyond_allowance || verdict_.error_rad > kModelLimit_rad;
}

Assessment SequentialEstimator::assess_ambiguous() const {
  using enum ReasonCode;
  const std::size_t count = hypotheses_.count();
  Assessment assessment{Quality::Ambiguous};
  if (count > 1) {
    const SpinFilter& filter = hypotheses_.all()[1].filter;
    const RaDec other = ra_dec_of(filter.axis_icrf());
    assessment.reasons.push_back(
        {OtherAxis,
         {{"ra_deg", degrees(other.ra_rad)},
          {"dec_deg", degrees(other.dec_rad)},
          {"sigma_deg", degrees(std::sqrt(filter.total_covariance_rad2().trace()))}}});
  }
  if (hypotheses_.provisional()) {
    assessment.reasons.push_back({FixesNearTangent});
  } else if (count > 2) {
    assessment.reasons.push_back({MoreAxes, {{"count", static_cast<std::int64_t>(count - 2)}}});
  } else {
    if (count == 1) {
      assessment.reasons.push_back({NothingSettled});
    }
    assessment.reasons.push_back({Revolutions, {{"count", ledger_.turns()}}});
  }
  return assessment;
}

/// Returns empty without doubt; a model error within its allowance causes none.
std::optional<Reason> SequentialEstimator::doubt() const {
  using enum ReasonCode;
  if (const auto channel = ledger_.mostly_left_out()) {
    return Reason{ChannelGated, {{"channel", std::string{name_of(channel_of(*channel))}}}};
  }
  // Share of gated edges beyond which some of the used ones are likely wrong, too.
  if (ledger_.all().share_left_out() > 1.0 / 3.0) {
    return Reason{ManyGated};
  }
  if (verdict_.excess_noise > 1.0) {
    return Reason{Noise, {{"factor", std::sqrt(verdict_.excess_noise)}}};
  }
  if (verdict_.error_rad > 0.0) {
    return model_contradicts() ? std::optional{verdict_.reason()} : std::nullopt;
  }
  // If the edges beat rival filters, the search covered more than one starting point.
  if (start_confirmation_.unconfirmed() && !hypotheses_.settled_by_edges()) {
    return Reason{StartUnconfirmed};
  }
  return std::nullopt;
}

Assessment SequentialEstimator::assess() const {
  using enum ReasonCode;
  const Reason gated{EdgesGated, {{"count", ledger_.all().left_out()}}};
  if (most_left_out()) {
    return {Quality::Lost, {gated, {AwaitingFix}}};
  }
  // Edges before the start might have contradicted the prior, so it stands only after the filters
  // have seen as many revolutions.
  if (!hypotheses_.settled() &&
      !(hypotheses_.prior_stands() && ledger_.turns() >= revolutions_before_start_)) {
    return assess_ambiguous();
  }
  const Reason revolutions{Revolutions, {{"count", ledger_.turns()}}};
  if (auto doubted = doubt()) {
    return {Quality::Doubtful, {*std::move(doubted), revolutions}};
  }
  const Quality unopposed = unopposed_quality(static_cast<double>(ledger_.turns()));
  if (verdict_.error_rad > 0.0) {
    return {unopposed, {verdict_.reason(), revolutions}};
  }
  Assessment assessment{unopposed, {revolutions, gated}};
  if (model_leverage() > kPoorLeverage) {
    assessment.reasons.push_back({PoorLeverage});
  }
  if (prior_refuted_) {
    assessment.reasons.push_back({PriorRefuted});
  } else if (restarted_) {
    assessment.reasons.push_back({*restarted_});
  }
  return assessment;
}

}  // namespace spindrift
