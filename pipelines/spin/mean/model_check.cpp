#include "pipelines/spin/mean/model_check.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/types/spin_alignment_evidence.h"
#include "pipelines/statistics/distributions.h"
#include "pipelines/statistics/significance.h"
#include "pipelines/statistics/symmetric_eigen.h"

namespace spindrift {
namespace {

using ErrorMatrix = Eigen::Matrix<double, kModelErrors, kModelErrors>;
using Errors = Eigen::Matrix<double, kModelErrors, 1>;
using Limits = std::array<double, kModelErrors + 1>;
using Normal = Eigen::Matrix<double, AngleEquations::kUnknowns, AngleEquations::kUnknowns>;
using Right = Eigen::Matrix<double, AngleEquations::kUnknowns, 1>;
using SomeErrors = Eigen::VectorXd;
using SomeErrorsMatrix = Eigen::MatrixXd;

/// Confidence that the errors do not exceed their upper limit.
constexpr double kCovered = 0.9;
// A combination of errors counts as unseen when its sigma exceeds this.
constexpr double kUnseen_rad = 0.1;

/// Limits of the chi-square by the number of seen errors.
Limits limits_beyond(double chance) {
  Limits limits{};
  for (std::size_t freedom = 1; freedom < limits.size(); ++freedom) {
    limits.at(freedom) = chi_square_beyond(chance, static_cast<double>(freedom));
  }
  return limits;
}
const Limits kLeast = limits_beyond(kCovered);
const Limits kSignificant = limits_beyond(kFalseAlarm);
const Limits kContradictory = limits_beyond(kContradictionChance);

/// Holds some of the errors in the eigenvectors of their information, with the axis eliminated and
/// the other errors zero.
class Spectrum {
 public:
  Spectrum(const SomeErrorsMatrix& information, const SomeErrors& score, double noise)
      : noise_{noise},
        information_{symmetric_eigen(information)},
        scores_{information_.vectors.transpose() * score} {}

  std::size_t freedom() const { return static_cast<std::size_t>(seen().count()); }

  /// Returns the chi-square if each error has this variance besides the noise.
  double chi_square(double error_rad2) const {
    const auto& informations = information_.values.array();
    return seen()
        .select(scores_.array().square() / (informations * (noise_ + informations * error_rad2)),
                0.0)
        .sum();
  }

  /// Returns the largest error variance that is not unlikely.
  double upper_end_rad2() const {
    const double least = kLeast.at(freedom());
    double low_rad = 0.0;
    double high_rad = 1.0;
    for (int i = 0; i < 30; ++i) {
      const double middle_rad = 0.5 * (low_rad + high_rad);
      (chi_square(middle_rad * middle_rad) > least ? low_rad : high_rad) = middle_rad;
    }
    return high_rad * high_rad;
  }

  /// Returns the mean products of the errors, given this variance as their prior.
  SomeErrorsMatrix mean_products_rad2(double error_rad2) const {
    const SomeErrors gain = gain_rad2(error_rad2);
    const SomeErrors seen_rad = gain.cwiseProduct(scores_);
    const SomeErrorsMatrix rest_rad2 = (noise_ * gain).asDiagonal();
    return information_.vectors * (rest_rad2 + seen_rad * seen_rad.transpose()) *
           information_.vectors.transpose();
  }

  /// Returns the reduction of the pass's chi-square by such errors.
  double explained(double error_rad2) const {
    const SomeErrors seen_rad = gain_rad2(error_rad2).cwiseProduct(scores_);
    return (2.0 * seen_rad.dot(scores_) -
            seen_rad.cwiseAbs2().dot(information_.values.cwiseMax(0.0))) /
           noise_;
  }

 private:
  Eigen::Array<bool, Eigen::Dynamic, 1> seen() const {
    return information_.values.array() > 1.0 / (kUnseen_rad * kUnseen_rad);
  }
  SomeErrors gain_rad2(double error_rad2) const {
    return error_rad2 / (noise_ + error_rad2 * information_.values.array().max(0.0));
  }

  double noise_;
  SymmetricEigen information_;
  SomeErrors scores_;
};

/// Sets of errors with one cause: one value in the mission file, both mounting angles or the
/// horizon height, the azimuth of the sun sensor, or everything.
const std::array<std::vector<int>, 8> kMistakes = {
    {{NorthLimb},
     {SouthLimb},
     {SunAngleError},
     {NorthAzimuth},
     {SouthAzimuth},
     {NorthLimb, SouthLimb},
     {NorthAzimuth, SouthAzimuth},
     {NorthLimb, SouthLimb, SunAngleError, NorthAzimuth, SouthAzimuth}}};

/// Averages the error products over all mistakes, weighted by how well each explains the residuals.
/// An error that is hardly seen because it moves the axis is found in full size if nothing else
/// explains its seen part.
void explain(const ErrorMatrix& information, const Errors& score, ModelTest& verdict) {
  struct Explanation {
    double log_weight;
    ErrorMatrix errors_rad2;
  };
  std::vector<Explanation> explanations;
  for (const std::vector<int>& mistake : kMistakes) {
    const Spectrum spectrum{information(mistake, mistake), score(mistake), verdict.excess_noise};
    if (spectrum.freedom() > 0) {
      const double error_rad2 = spectrum.upper_end_rad2();
      ErrorMatrix errors_rad2 = ErrorMatrix::Zero();
      errors_rad2(mistake, mistake) = spectrum.mean_products_rad2(error_rad2);
      // Akaike's criterion: a parameter must explain more than its own noise does.
      explanations.push_back(
          {.log_weight = 0.5 * spectrum.explained(error_rad2) - static_cast<double>(mistake.size()),
           .errors_rad2 = errors_rad2});
    }
  }
  const double most =
      std::max_element(explanations.begin(), explanations.end(), [](const auto& a, const auto& b) {
        return a.log_weight < b.log_weight;
      })->log_weight;
  double weights = 0.0;
  for (const Explanation& explanation : explanations) {
    const double weight = std::exp(explanation.log_weight - most);
    weights += weight;
    verdict.errors_rad2 += weight * explanation.errors_rad2;
  }
  verdict.errors_rad2 /= weights;
  verdict.error_rad = std::sqrt(verdict.errors_rad2.diagonal().maxCoeff());
}

/// Tests the noise by what model errors and the mission file's errors do not explain.
double excess_noise(const AngleEquations& equations, const SpinAlignment& alignment) {
  Normal normal = equations.normal();
  Right right = equations.right();
  const double explained =
      equations.considered().eliminate(considered_prior(alignment), normal, right);
  // The unit prior keeps undetermined directions in place.
  normal += Normal::Identity();
  const double fitted = right.dot(normal.ldlt().solve(right));
  const double freedom = equations.angles() - AngleEquations::kUnknowns;
  if (!(freedom > 0.0)) {
    return 1.0;
  }
  const double excess = (equations.squares() - explained - fitted) / freedom;
  // Caps the angles for the noise test, so that noise slightly above the stated is not called
  // wrong.
  return variance_factor(excess, std::min(freedom, 300.0));
}

// Evidence from before a restart keeps the weight of this many edges.
constexpr double kFadedEdges = 100.0;

}  // namespace

Reason ModelTest::reason() const {
  Reason reason{ReasonCode::ModelOff, {{"deg", degrees(error_rad)}}};
  if (culprit) {
    reason.values.push_back({"key", std::string{kSpinAlignmentKeys.at(*culprit)}});
  }
  return reason;
}

ModelTest test_model(const AngleEquations& equations, const ConsideredPrior& prior) {
  return test_model_errors(equations.less_axis(), excess_noise(equations, of_alignment(prior)),
                           prior);
}

ModelTest test_model_errors(const ErrorInformation& seen, double excess_noise,
                            const ConsideredPrior& prior) {
  ModelTest verdict{.excess_noise = excess_noise};
  ErrorInformation errors = seen;
  errors.considered.eliminate(prior, errors.information, errors.score);
  const Spectrum spectrum{errors.information, errors.score, excess_noise};
  if (spectrum.freedom() == 0) {
    return verdict;
  }
  const double significant = kSignificant.at(spectrum.freedom());
  if (!(spectrum.chi_square(0.0) > significant)) {
    return verdict;
  }
  explain(errors.information, errors.score, verdict);
  const SpinAlignment alignment = of_alignment(prior);
  verdict.beyond_allowance =
      is_stated(alignment) ? spectrum.chi_square(0.0) > kContradictory.at(spectrum.freedom())
                           : spectrum.chi_square(kModelError_rad * kModelError_rad) > significant;
  if (const auto worst = worst_excess(
          beside_offsets(seen.considered.own, seen.considered.score, prior), alignment)) {
    verdict.culprit = worst->error;
  }
  return verdict;
}

void ModelEvidence::add(const ErrorInformation& errors, double edges) {
  edges_ += edges;
  errors_ += errors;
}

void ModelEvidence::fade() {
  const double share = edges_ > kFadedEdges ? kFadedEdges / edges_ : 1.0;
  edges_ *= share;
  errors_ *= share;
}

}  // namespace spindrift
