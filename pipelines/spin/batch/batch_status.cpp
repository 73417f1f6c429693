#include "pipelines/spin/batch/batch_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;
// Of the prior: what is so far off is no misplacement.
constexpr double kFarOff_sigmas = 4.0;

bool is_far_off(const BiasEstimate& bias) {
  return bias.estimated && std::abs(bias.value) > kFarOff_sigmas * prior_of(bias.bias).sigma;
}

bool is_doubtful(const BatchSolution& solution, const BatchDoubts& doubts) {
  const auto outliers = static_cast<double>(solution.outliers);
  const bool dirty = outliers > kManyOutliers * (outliers + static_cast<double>(solution.edges));
  const bool contradicted = doubts.left_out && (rests_on_few(solution, *doubts.left_out) ||
                                                !doubts.left_out->fit_one_attitude);
  return solution.noise > 1.0 || dirty || contradicted || doubts.at_bound.any() || doubts.wanted ||
         (doubts.coning_by_edges && solution.coning.verdict.detected) ||
         std::any_of(solution.biases.begin(), solution.biases.end(), is_far_off);
}

std::string first_word(const BatchSolution& solution, const BatchDoubts& doubts) {
  if (doubts.or_axis_icrf) {
    const RaDec other = ra_dec_of(*doubts.or_axis_icrf);
    return fmt::format("AMBIGUOUS, or ra {:.2f} dec {:.2f} deg", other.ra_rad / kDegree_rad,
                       other.dec_rad / kDegree_rad);
  }
  return is_doubtful(solution, doubts) ? "DOUBTFUL" : "OK";
}

std::string change_in_words(const BatchSolution& solution, const LeftOut& left_out) {
  std::string words =
      fmt::format(" since {}, where attitude or rate changed", format_utc(left_out.until, 0));
  if (rests_on_few(solution, left_out)) {
    words += fmt::format(", {} edges before that are left out: most of the pass", left_out.edges);
  }
  if (!left_out.fit_one_attitude) {
    words += ", no one axis fits the edges before that";
  }
  return words;
}

/// What the body does that is no even spin.
std::string motion_in_words(const BatchSolution& solution, const BatchDoubts& doubts) {
  std::string words;
  if (solution.nutation && solution.nutation->found) {
    const FoundNutation& nutation = *solution.nutation->found;
    words += fmt::format(", nutation {:.3f} deg, period {:.3f} s",
                         nutation.half_angle_rad.value / kDegree_rad, nutation.period_s.value);
    for (const double other_s : nutation.other_periods_s) {
      words += fmt::format(" or {:.3f} s", other_s);
    }
  }
  if (solution.coning.verdict.detected) {
    words += fmt::format(", coning {:.3f} +/- {:.3f} deg",
                         solution.coning.verdict.tilt_rad / kDegree_rad,
                         solution.coning.tilt_sigma_rad / kDegree_rad);
    words +=
        doubts.coning_by_edges ? " or a misplaced sensor (coning in [spin.batch] decides)" : "";
  } else if (doubts.estimated[ConingX]) {
    words += fmt::format(", no coning above {:.3f} deg",
                         solution.coning.verdict.detectable_rad / kDegree_rad);
  }
  return words;
}

std::string bias_in_words(const BiasEstimate& bias) {
  const BiasPrior& prior = prior_of(bias.bias);
  const double unit = prior.is_angle ? kDegree_rad : 1.0;
  if (!bias.observable) {
    return fmt::format(", {} not determined", prior.words);
  }
  return fmt::format(
      ", {} {:+.3f} +/- {:.3f} {}{}", prior.words, bias.value / unit, bias.sigma / unit,
      prior.is_angle ? "deg" : "km",
      is_far_off(bias) ? fmt::format(" (more than {:.0f} times its prior)", kFarOff_sigmas) : "");
}

}  // namespace

bool rests_on_few(const BatchSolution& solution, const LeftOut& left_out) {
  return left_out.edges + solution.outliers > 2 * solution.edges;
}

std::string status_of(const BatchSolution& solution, const BatchDoubts& doubts) {
  std::string status = first_word(solution, doubts) + fmt::format(", {} edges", solution.edges);
  if (doubts.left_out) {
    status += change_in_words(solution, *doubts.left_out);
  }
  if (solution.outliers > 0) {
    status += fmt::format(", {} outliers", solution.outliers);
  }
  status += motion_in_words(solution, doubts);
  if (solution.noise > 1.0) {
    status += fmt::format(", noise x {:.1f}", solution.noise);
  }
  if ((doubts.at_bound & unknowns_of(ConingX)).any()) {
    status += ", coning runs to its bound";
  }
  for (const BiasEstimate& bias : solution.biases) {
    const auto index = static_cast<std::size_t>(bias.bias);
    if (doubts.at_bound[index]) {
      status += fmt::format(", {} runs to its bound", prior_of(bias.bias).words);
    } else if (bias.estimated) {
      status += bias_in_words(bias);
    }
  }
  if (doubts.wanted) {
    status += fmt::format(", residuals ask for {}", prior_of(*doubts.wanted).words);
  }
  return status;
}

}  // namespace spindrift
