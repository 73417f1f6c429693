#include "pipelines/spin/consistency/block_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/sphere_spiral.h"
#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "pipelines/spin/types/alignment.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

/// Tilts of the axis, lateness against the orbit, errors of the mission file as independent ones of
/// unit variance.
constexpr int kTilts = 2;
constexpr int kLate = kTilts;
constexpr int kFirstError = kLate + 1;
constexpr int kUnknowns = kFirstError + kSpinAlignmentErrors;
using Slopes = Eigen::Matrix<double, 1, kUnknowns>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;

constexpr int kMostSteps = 20;
constexpr double kLongestStep_rad = 0.2;
// After a step this short the equations are linear to a fraction of the noise.
constexpr double kLastStep_rad = 3e-5;
// An edge that the state does not have counts as being so far off.
constexpr double kFarOff_rad = 0.5;
// Prior of the lateness: a wild one only keeps the equations regular.
constexpr double kLate_s = 1000.0;

double square(double x) { return x * x; }

/// Holds how far a point is from where a state expects it.
struct ComparedPoint {
  PulseChannel channel;
  bool counts;     ///< False if it is omitted.
  double off_rad;  ///< Azimuth behind the expected one, plus the phase of the block.
  double sigma_rad;
  Slopes slopes;
};

/// Returns the phase of the block with which the points that count are where they are expected.
double phase_of(const std::vector<ComparedPoint>& points) {
  double weights = 0.0;
  double sum_rad = 0.0;
  for (const ComparedPoint& point : points) {
    if (point.counts) {
      const double weight = 1.0 / square(point.sigma_rad);
      weights += weight;
      sum_rad -= weight * point.off_rad;
    }
  }
  return weights > 0.0 ? sum_rad / weights : 0.0;
}

class AxisState {
 public:
  AxisState(const SpinConfig& config, const OmittedSensors& omitted, const Eigen::Vector3d& axis)
      : config_{&config},
        omitted_{&omitted},
        sensors_{config, SensorBiases::Zero()},
        alignment_root_{root_of(config.alignment)},
        q_icrf_spin_{frame_about(axis)} {}

  Eigen::Vector3d axis_icrf() const { return q_icrf_spin_ * Eigen::Vector3d::UnitZ(); }
  double late_s() const { return late_s_; }

  void move(const Unknowns& step) {
    const Eigen::Vector3d tilt_rad{step[0], step[1], 0.0};
    const double angle_rad = tilt_rad.norm();
    if (angle_rad > 0.0) {
      q_icrf_spin_ =
          (q_icrf_spin_ * Eigen::AngleAxisd{angle_rad, tilt_rad / angle_rad}).normalized();
    }
    late_s_ += step[kLate];
  }

  /// Points whose edges the state does not have, or nearly none of, are linearised by their depth
  /// in the disc once the others give the phase.
  /// @param missing Receives the sum of squares of those that have none nearby.
  std::vector<ComparedPoint> compare(const BlockUnderSky& seen, double& missing) const {
    Sky sky = seen.sky;
    sky.t = later_by_s(sky.t, late_s_);
    const Eigen::Matrix3d R_spin_icrf = q_icrf_spin_.conjugate().toRotationMatrix();
    std::vector<ComparedPoint> all;
    std::vector<const ChannelPoint*> without;
    for (const ChannelPoint& point : seen.block.points) {
      if (const auto edge = predict_edge(sensors_, sky, R_spin_icrf, point.edge)) {
        all.push_back(compared(seen.block, point, *edge));
      } else if (!omitted_->channels[index_of(point.edge.channel)]) {
        without.push_back(&point);
      }
    }
    unwrap(all);
    const double phase_rad = phase_of(all);
    for (const ChannelPoint* const point : without) {
      const double sigma_rad = seen.block.rate_rad_s * point->sigma_s;
      const auto edge = linearise_by_depth(*config_, sky, R_spin_icrf, point->edge,
                                           measured_rad(seen.block, *point) + phase_rad, sigma_rad);
      if (edge) {
        all.push_back(compared(seen.block, *point, *edge));
        all.back().off_rad = wrapped_rad(all.back().off_rad + phase_rad) - phase_rad;
      } else {
        missing += square(kFarOff_rad / sigma_rad);
      }
    }
    return all;
  }

 private:
  static double measured_rad(const ChannelBlock& block, const ChannelPoint& point) {
    return block.rate_rad_s * seconds_between(block.t, point.edge.t);
  }

  ComparedPoint compared(const ChannelBlock& block, const ChannelPoint& point,
                         const PredictedEdge& edge) const {
    ComparedPoint one{.channel = point.edge.channel,
                      .counts = !omitted_->channels[index_of(point.edge.channel)],
                      .off_rad = measured_rad(block, point) - edge.phase_rad,
                      .sigma_rad = block.rate_rad_s * point.sigma_s,
                      .slopes = Slopes::Zero()};
    one.slopes.head<kTilts>() = -edge.phase_per_rotation.head<kTilts>().transpose();
    one.slopes[kLate] = omitted_->orbit ? -edge.phase_per_alignment[TimeTagError] : 0.0;
    one.slopes.tail<kSpinAlignmentErrors>() = -edge.phase_per_alignment * alignment_root_;
    return one;
  }

  /// Brings all to within half a turn of the first one that counts.
  static void unwrap(std::vector<ComparedPoint>& points) {
    const auto first = std::find_if(points.begin(), points.end(),
                                    [](const ComparedPoint& point) { return point.counts; });
    if (first != points.end()) {
      const double anchor_rad = first->off_rad;
      for (ComparedPoint& point : points) {
        point.off_rad = anchor_rad + wrapped_rad(point.off_rad - anchor_rad);
      }
    }
  }

  const SpinConfig* config_;
  const OmittedSensors* omitted_;
  PlacedSensors sensors_;
  SpinAlignment alignment_root_;
  Eigen::Quaterniond q_icrf_spin_;
  double late_s_ = 0.0;
};

/// Holds the equations of a block with its phase eliminated.
struct Equations {
  Normal normal = Normal::Zero();
  Unknowns score = Unknowns::Zero();
  double squares = 0.0;
  int freedom = 0;

  void add(const std::vector<ComparedPoint>& points) {
    double weights = 0.0;
    double sum = 0.0;
    Unknowns slopes = Unknowns::Zero();
    for (const ComparedPoint& point : points) {
      if (point.counts) {
        const double weight = 1.0 / square(point.sigma_rad);
        weights += weight;
        sum += weight * point.off_rad;
        slopes += weight * point.slopes.transpose();
        squares += weight * square(point.off_rad);
        score += weight * point.off_rad * point.slopes.transpose();
        normal += weight * point.slopes.transpose() * point.slopes;
        ++freedom;
      }
    }
    if (weights > 0.0) {
      squares -= square(sum) / weights;
      score -= slopes * (sum / weights);
      normal -= slopes * slopes.transpose() / weights;
      --freedom;
    }
  }
};

Equations equations(const AxisState& state, std::span<const BlockUnderSky> blocks) {
  Equations sum;
  for (const BlockUnderSky& block : blocks) {
    sum.add(state.compare(block, sum.squares));
  }
  return sum;
}

struct Solved {
  Unknowns step;        ///< Step to the best state.
  Unknowns errors;      ///< Errors of the mission file that fit best at this state.
  double squares_here;  ///< Chi-square with them.
};

Solved solve(const Equations& sum) {
  Unknowns prior = Unknowns::Ones();
  prior[kLate] = 1.0 / square(kLate_s);
  const Normal normal = sum.normal + Normal{prior.asDiagonal()};
  Solved solved{.step = -Eigen::LDLT<Normal>{normal}.solve(sum.score),
                .errors = Unknowns::Zero(),
                .squares_here = sum.squares};
  using Errors = Eigen::Matrix<double, kSpinAlignmentErrors, kSpinAlignmentErrors>;
  const auto score = sum.score.tail<kSpinAlignmentErrors>();
  solved.errors.tail<kSpinAlignmentErrors>() =
      -Eigen::LDLT<Errors>{
          Errors{normal.bottomRightCorner<kSpinAlignmentErrors, kSpinAlignmentErrors>()}}
           .solve(score);
  solved.squares_here += score.dot(solved.errors.tail<kSpinAlignmentErrors>());
  return solved;
}

/// Returns the azimuths of each channel behind its expected one in each block.
std::vector<BlockFit::Azimuths> off_rad(const AxisState& state,
                                        std::span<const BlockUnderSky> blocks,
                                        const Unknowns& errors) {
  std::vector<BlockFit::Azimuths> all;
  for (const BlockUnderSky& block : blocks) {
    all.emplace_back().fill(std::numeric_limits<double>::quiet_NaN());
    double missing = 0.0;
    std::vector<ComparedPoint> points = state.compare(block, missing);
    for (ComparedPoint& point : points) {
      point.off_rad += point.slopes.dot(errors);
    }
    const double phase_rad = phase_of(points);
    for (const ComparedPoint& point : points) {
      all.back().at(index_of(point.channel)) = wrapped_rad(point.off_rad + phase_rad);
    }
  }
  return all;
}

constexpr int kPlaces = 600;
constexpr double kBasin_rad = 0.35;
constexpr std::size_t kMostBest = 3;
// Azimuth by which an edge may be off at a place near the axis.
constexpr double kNear_rad = 0.2;
// Squared azimuths, in units of kNear_rad, beyond which an edge is just wrong.
constexpr double kWrong = 9.0;

}  // namespace

std::optional<BlockFit> fit_axis(const SpinConfig& config, std::span<const BlockUnderSky> blocks,
                                 const OmittedSensors& omitted, const Eigen::Vector3d& start_icrf) {
  AxisState state{config, omitted, start_icrf};
  AxisState next = state;
  std::optional<BlockFit> best;
  Unknowns step = Unknowns::Zero();
  for (int i = 0; i < kMostSteps; ++i) {
    const Equations sum = equations(next, blocks);
    const int freedom = sum.freedom - kTilts - (omitted.orbit ? 1 : 0);
    if (freedom < 0) {
      return std::nullopt;
    }
    const Solved solved = solve(sum);
    if (!best || solved.squares_here < best->squares) {
      state = next;
      step = solved.step;
      best = BlockFit{.axis_icrf = state.axis_icrf(),
                      .squares = solved.squares_here,
                      .freedom = freedom,
                      .late_s = state.late_s(),
                      .off_rad = {}};
    } else {
      step *= 0.3;
    }
    const double length_rad = step.head<kTilts>().norm();
    if (length_rad < kLastStep_rad) {
      break;
    }
    step *= std::min(1.0, kLongestStep_rad / length_rad);
    next = state;
    next.move(step);
  }
  best->off_rad = off_rad(state, blocks, solve(equations(state, blocks)).errors);
  return best;
}

BlockFit::Azimuths mean_of(std::span<const BlockFit::Azimuths> off_rad) {
  BlockFit::Azimuths mean{};
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    int count = 0;
    for (const BlockFit::Azimuths& one : off_rad) {
      if (!std::isnan(one.at(i))) {
        mean.at(i) += one.at(i);
        ++count;
      }
    }
    mean.at(i) /= count;
  }
  return mean;
}

SkyOfAxes::SkyOfAxes(const SpinConfig& config, const BlockUnderSky& seen) {
  const PlacedSensors sensors{config, SensorBiases::Zero()};
  for (const ChannelPoint& point : seen.block.points) {
    channels_.push_back(point.edge.channel);
  }
  for (int i = 0; i < kPlaces; ++i) {
    Place& place =
        places_.emplace_back(Place{.axis_icrf = place_on_spiral(i, kPlaces), .off_rad = {}});
    const Eigen::Matrix3d R_spin_icrf = frame_about(place.axis_icrf).conjugate().toRotationMatrix();
    for (const ChannelPoint& point : seen.block.points) {
      const auto edge = predict_edge(sensors, seen.sky, R_spin_icrf, point.edge);
      place.off_rad.push_back(
          edge ? std::optional{seen.block.rate_rad_s * seconds_between(seen.block.t, point.edge.t) -
                               edge->phase_rad}
               : std::nullopt);
    }
  }
}

double SkyOfAxes::cost(const Place& place, const OmittedSensors& omitted) const {
  std::complex<double> sum;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (place.off_rad[i] && !omitted.channels[index_of(channels_[i])]) {
      sum += std::polar(1.0, *place.off_rad[i]);
    }
  }
  double cost = 0.0;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (!omitted.channels[index_of(channels_[i])]) {
      cost +=
          place.off_rad[i]
              ? std::min(square(wrapped_rad(*place.off_rad[i] - std::arg(sum)) / kNear_rad), kWrong)
              : kWrong;
    }
  }
  return cost;
}

std::vector<Eigen::Vector3d> SkyOfAxes::best(const OmittedSensors& omitted) const {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    order.emplace_back(cost(places_[i], omitted), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<Eigen::Vector3d> best;
  for (const auto& [cost, i] : order) {
    const Eigen::Vector3d& axis_icrf = places_[i].axis_icrf;
    const bool is_new = std::none_of(best.begin(), best.end(), [&](const Eigen::Vector3d& other) {
      return angle_between_rad(other, axis_icrf) < kBasin_rad;
    });
    if (is_new) {
      best.push_back(axis_icrf);
    }
    if (best.size() == kMostBest) {
      break;
    }
  }
  return best;
}

}  // namespace spindrift
