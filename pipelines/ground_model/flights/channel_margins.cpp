#include "pipelines/ground_model/flights/channel_margins.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "pipelines/frames/angle.h"

namespace spindrift {
namespace {

/// Returns just under half the sampling frequency, as rounding could put the exact value beyond.
double half_sampling_rad_s(const LoopSampling& sampling) {
  return (1.0 - 1e-12) * std::numbers::pi / sampling.period_s;
}

/// Returns the root of a function that is positive just beside `above` and not positive at `below`.
template <class Function>
double root_between(double above, double below, const Function& function) {
  for (int i = 0; i < 100; ++i) {
    const double middle = std::midpoint(above, below);
    (function(middle) > 0.0 ? above : below) = middle;
  }
  return below;
}

/// Returns the root w of J^2 w^4 = kd^2 w^2 + kp^2 / 4, the crossover of the continuous loop.
double continuous_crossover_rad_s(const ChannelLoop& loop) {
  const double rate = loop.kd_nms / loop.moment_kg_m2;
  const double angle = loop.kp_nm / loop.moment_kg_m2;
  return std::sqrt(0.5 * (rate * rate + std::hypot(rate * rate, angle)));
}

Expected<void> check(const ChannelLoop& loop) {
  const double period_s = loop.sampling ? loop.sampling->period_s : 1.0;
  // Written so that NaN fails.
  if (!(loop.moment_kg_m2 > 0.0 && loop.kp_nm > 0.0 && loop.kd_nms > 0.0 && period_s > 0.0)) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("a loop of {} kg m2, kp {} N m, kd {} N m s and {} s: must be "
                                   "above 0",
                                   loop.moment_kg_m2, loop.kp_nm, loop.kd_nms, period_s)}};
  }
  if (loop.sampling && open_loop_at(loop, half_sampling_rad_s(*loop.sampling)).gain > 1.0) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("a loop of kd / J = {:.4g} 1/s is not closed by a period of {} s: its gain "
                     "must fall to 1 within half the sampling frequency",
                     loop.kd_nms / loop.moment_kg_m2, period_s)}};
  }
  const double late_s = loop.sampling ? (0.5 + loop.sampling->periods_late) * period_s : 0.0;
  if (const double lead_s = 2.0 * loop.kd_nms / loop.kp_nm; !(lead_s > late_s)) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("a loop that leads by 2 kd / kp = {:.4g} s swings with any gain "
                                   "where its torque comes {:.4g} s late: must come earlier",
                                   lead_s, late_s)}};
  }
  return {};
}

}  // namespace

BodePoint open_loop_at(const ChannelLoop& loop, double frequency_rad_s) {
  double rate = loop.kd_nms / (loop.moment_kg_m2 * frequency_rad_s);
  double angle = 0.5 * loop.kp_nm / (loop.moment_kg_m2 * frequency_rad_s * frequency_rad_s);
  double late_rad = 0.0;
  if (const auto& sampling = loop.sampling) {
    // z - 1 = 2i sin(half) e^(i half), z + 1 = 2 cos(half) e^(i half)
    const double half_rad = 0.5 * frequency_rad_s * sampling->period_s;
    const double sine_ratio = half_rad / std::sin(half_rad);
    rate *= sine_ratio;
    angle *= sine_ratio * sine_ratio * std::cos(half_rad);
    late_rad = (1 + 2 * sampling->periods_late) * half_rad;
  }
  return {.frequency_rad_s = frequency_rad_s,
          .gain = std::hypot(rate, angle),
          .phase_rad = -std::numbers::pi + std::atan2(rate, angle) - late_rad};
}

std::vector<BodePoint> bode(const ChannelLoop& loop, double from_rad_s, double to_rad_s,
                            int points) {
  std::vector<BodePoint> all;
  all.reserve(static_cast<std::size_t>(points));
  for (int i = 0; i < points; ++i) {
    all.push_back(
        open_loop_at(loop, from_rad_s * std::pow(to_rad_s / from_rad_s, i / (points - 1.0))));
  }
  return all;
}

Expected<LoopMargins> loop_margins(const ChannelLoop& loop) {
  if (const auto good = check(loop); !good) {
    return Unexpected{good.error()};
  }
  const auto phase_margin_rad = [&](double frequency_rad_s) {
    return open_loop_at(loop, frequency_rad_s).phase_rad + std::numbers::pi;
  };
  if (!loop.sampling) {
    const double crossover_rad_s = continuous_crossover_rad_s(loop);
    return LoopMargins{.phase_rad = phase_margin_rad(crossover_rad_s),
                       .crossover_rad_s = crossover_rad_s,
                       .gain = std::nullopt};
  }
  const double highest_rad_s = half_sampling_rad_s(*loop.sampling);
  const double crossover_rad_s = root_between(
      0.0, highest_rad_s, [&](double w_rad_s) { return open_loop_at(loop, w_rad_s).gain - 1.0; });
  const double turned_rad_s = root_between(0.0, highest_rad_s, phase_margin_rad);
  return LoopMargins{.phase_rad = phase_margin_rad(crossover_rad_s),
                     .crossover_rad_s = crossover_rad_s,
                     .gain = 1.0 / open_loop_at(loop, turned_rad_s).gain};
}

std::vector<std::complex<double>> closed_loop_poles(const ChannelLoop& loop, double factor) {
  const double rate = factor * loop.kd_nms / loop.moment_kg_m2;
  const double angle = factor * 0.5 * loop.kp_nm / loop.moment_kg_m2;
  // The state is the angle, the rate and the torques commanded in the periods before, latest first.
  const int late = loop.sampling ? loop.sampling->periods_late : 0;
  Eigen::MatrixXd next = Eigen::MatrixXd::Zero(2 + late, 2 + late);
  Eigen::RowVectorXd asked = Eigen::RowVectorXd::Zero(2 + late);
  asked.head<2>() << -angle, -rate;
  if (const auto& sampling = loop.sampling) {
    const double period_s = sampling->period_s;
    next.topLeftCorner<2, 2>() << 1.0, period_s, 0.0, 1.0;
    const Eigen::Vector2d of_torque{0.5 * period_s * period_s, period_s};
    if (late == 0) {
      next.topRows<2>() += of_torque * asked;
    } else {
      next.topRightCorner<2, 1>() += of_torque;
      next.row(2) = asked;
      next.bottomRows(late - 1).middleCols(2, late - 1).setIdentity();
    }
  } else {
    next.row(0) << 0.0, 1.0;
    next.row(1) = asked;
  }
  const Eigen::VectorXcd poles = next.eigenvalues();
  return {poles.begin(), poles.end()};
}

std::vector<LocusPoint> root_locus(const ChannelLoop& loop, std::span<const double> factors) {
  std::vector<LocusPoint> locus;
  for (const double factor : factors) {
    locus.push_back({.factor = factor, .poles = closed_loop_poles(loop, factor)});
  }
  return locus;
}

Expected<std::array<ChannelMargins, 3>> channel_margins(const OrientationTruth& truth) {
  const OrientationControl& control = truth.control;
  const PdGains gains = control.gains();
  std::array<ChannelMargins, 3> channels;
  for (int i = 0; i < 3; ++i) {
    ChannelMargins& channel = channels.at(static_cast<std::size_t>(i));
    channel.designed = {.moment_kg_m2 = control.moments_kg_m2[i],
                        .kp_nm = gains.kp_nm[i],
                        .kd_nms = gains.kd_nms[i]};
    channel.flown = channel.designed;
    channel.flown.moment_kg_m2 = truth.body.inertia_kg_m2(i, i);
    channel.flown.sampling =
        LoopSampling{.period_s = control.period_s, .periods_late = control.periods_late};
    const auto designed = loop_margins(channel.designed);
    const auto flown = loop_margins(channel.flown);
    if (!designed || !flown) {
      return Unexpected{designed ? flown.error() : designed.error()};
    }
    channel.designed_margins = *designed;
    channel.flown_margins = *flown;
  }
  return channels;
}

Expected<void> check_margins(const OrientationTruth& truth) {
  const auto channels = channel_margins(truth);
  if (!channels) {
    return Unexpected{channels.error()};
  }
  for (const ChannelMargins& channel : *channels) {
    if (const LoopMargins& margins = channel.flown_margins; !(margins.phase_rad > 0.0)) {
      return Unexpected{
          {ErrorCode::InvalidConfiguration,
           fmt::format("a loop of {:.4g} rad/s that is closed every {} s, {} periods late, swings: "
                       "its phase margin of {:.3g} deg must be above 0",
                       margins.crossover_rad_s, truth.control.period_s, truth.control.periods_late,
                       degrees(margins.phase_rad))}};
    }
  }
  return {};
}

}  // namespace spindrift
