#include "pipelines/spin/batch/batch_assessment.h"

#include <algorithm>
#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/convergence.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

bool is_far_off(const BiasEstimate& bias) {
  return bias.estimated && std::abs(bias.value) > kFarOffPriorSigmas * bias.stated_sigma;
}

bool is_doubtful(const BatchSolution& solution, const BatchDoubts& doubts) {
  const auto outliers = static_cast<double>(solution.outliers);
  const bool dirty = outliers > kManyOutliers * (outliers + static_cast<double>(solution.edges));
  const bool contradicted = doubts.left_out && (rests_on_few(solution, *doubts.left_out) ||
                                                !doubts.left_out->fit_one_attitude);
  return solution.noise > 1.0 || dirty || contradicted || doubts.at_bound.any() || doubts.wanted ||
         doubts.model_off || (doubts.coning_by_edges && solution.coning.verdict.detected) ||
         std::any_of(solution.biases.begin(), solution.biases.end(), is_far_off);
}

using Reasons = std::vector<Reason>;

void add_change(const BatchSolution& solution, const LeftOut& left_out, Reasons& reasons) {
  reasons.push_back({ReasonCode::Changed, {{"since_tai_ns", tai_ns(left_out.until)}}});
  if (rests_on_few(solution, left_out)) {
    reasons.push_back({ReasonCode::MostBeforeChange, {{"edges", left_out.edges}}});
  }
  if (!left_out.fit_one_attitude) {
    reasons.push_back({ReasonCode::NoAxisBeforeChange});
  }
}

/// Adds the reasons for nutation and coning.
void add_motion(const BatchSolution& solution, const BatchDoubts& doubts, Reasons& reasons) {
  using enum ReasonCode;
  if (solution.nutation && solution.nutation->found) {
    const FoundNutation& nutation = *solution.nutation->found;
    reasons.push_back(
        {Nutation,
         {{"deg", degrees(nutation.half_angle_rad.value)}, {"period_s", nutation.period_s.value}}});
    for (const double other_s : nutation.other_periods_s) {
      reasons.push_back({OtherNutationPeriod, {{"period_s", other_s}}});
    }
  }
  const ConingTest& coning = solution.coning.verdict;
  if (coning.detected) {
    reasons.push_back({Coning,
                       {{"deg", degrees(coning.tilt_rad)},
                        {"sigma_deg", degrees(solution.coning.tilt_sigma_rad)}}});
    if (doubts.coning_by_edges) {
      reasons.push_back({ConingOrMisplaced});
    }
  } else if (doubts.estimated[ConingX]) {
    reasons.push_back({NoConing, {{"detectable_deg", degrees(coning.detectable_rad)}}});
  }
}

NamedValue named(SensorBias bias) { return {"bias", std::string{range_of(bias).name}}; }

void add_bias(const BiasEstimate& bias, Reasons& reasons) {
  if (!bias.observable) {
    reasons.push_back({ReasonCode::BiasOpen, {named(bias.bias)}});
    return;
  }
  const bool is_angle = range_of(bias.bias).is_angle;
  const double unit = is_angle ? kRadPerDeg : 1.0;
  reasons.push_back({ReasonCode::Bias,
                     {named(bias.bias),
                      {"value", bias.value / unit},
                      {"sigma", bias.sigma / unit},
                      {"unit", is_angle ? "deg" : "km"}}});
  if (is_far_off(bias)) {
    reasons.push_back(
        {ReasonCode::BiasFarOff, {named(bias.bias), {"prior_sigmas", kFarOffPriorSigmas}}});
  }
}

void add_biases(const BatchSolution& solution, const BatchDoubts& doubts, Reasons& reasons) {
  if ((doubts.at_bound & unknowns_of(ConingX)).any()) {
    reasons.push_back({ReasonCode::BiasAtBound, {named(ConingX)}});
  }
  for (const BiasEstimate& bias : solution.biases) {
    if (doubts.at_bound[static_cast<std::size_t>(bias.bias)]) {
      reasons.push_back({ReasonCode::BiasAtBound, {named(bias.bias)}});
    } else if (bias.estimated) {
      add_bias(bias, reasons);
    }
  }
  if (doubts.model_off) {
    reasons.push_back(*doubts.model_off);
  }
  if (doubts.wanted) {
    reasons.push_back({ReasonCode::BiasWanted, {named(*doubts.wanted)}});
  }
}

}  // namespace

bool rests_on_few(const BatchSolution& solution, const LeftOut& left_out) {
  return left_out.edges + solution.outliers > 2 * solution.edges;
}

Assessment assess(const BatchSolution& solution, const BatchDoubts& doubts) {
  using enum ReasonCode;
  Assessment assessment{is_doubtful(solution, doubts) ? Quality::Doubtful
                                                      : unopposed_quality(doubts.revolutions)};
  Reasons& reasons = assessment.reasons;
  if (doubts.alternate_axis_icrf) {
    assessment.quality = Quality::Ambiguous;
    const RaDec other = ra_dec_of(*doubts.alternate_axis_icrf);
    // Mirror solutions are known about equally well.
    reasons.push_back(
        {OtherAxis,
         {{"ra_deg", degrees(other.ra_rad)},
          {"dec_deg", degrees(other.dec_rad)},
          {"sigma_deg", degrees(std::sqrt(solution.estimate.covariance_rad2.trace()))}}});
  }
  reasons.push_back({Edges, {{"count", solution.edges}}});
  if (doubts.left_out) {
    add_change(solution, *doubts.left_out, reasons);
  }
  if (solution.outliers > 0) {
    reasons.push_back({Outliers, {{"count", solution.outliers}}});
  }
  add_motion(solution, doubts, reasons);
  if (solution.noise > 1.0) {
    reasons.push_back({Noise, {{"factor", solution.noise}}});
  }
  add_biases(solution, doubts, reasons);
  return assessment;
}

}  // namespace spindrift
