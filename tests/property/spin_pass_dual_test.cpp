#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/spin_pass.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift {
namespace {
using enum PulseChannel;
constexpr double kPi = std::numbers::pi;
constexpr double kDegree_rad = kPi / 180.0;

Orbit random_orbit(std::mt19937_64& rng) {
  std::uniform_real_distribution<double> u;
  return Orbit{
      KeplerOrbit::make({.epoch = testing::kTransferStart,
                         .semi_major_axis_km = 24400.0,
                         .eccentricity = 0.73,
                         .inclination_rad = 60.0 * u(rng) * kDegree_rad,
                         .raan_rad = 2.0 * kPi * u(rng),
                         .argument_of_perigee_rad = 2.0 * kPi * u(rng),
                         .mean_anomaly_rad = (0.2 + 0.5 * u(rng)) * (u(rng) < 0.5 ? -1.0 : 1.0)})
          .value()};
}

TEST(Dual, Explore) {
  std::map<std::string, std::set<PulseChannel>> lost = {{"4", {Sun2}},
                                                        {"5", {Sun2, SouthIn, SouthOut}},
                                                        {"6", {Sun2, NorthIn, NorthOut}},
                                                        {"7", {Sun1}},
                                                        {"7b", {Sun1, SouthIn, SouthOut}}};
  std::mt19937_64 rng{77};
  const int revs = std::getenv("REVS") ? atoi(std::getenv("REVS")) : 300;
  const int passes = std::getenv("PASSES") ? atoi(std::getenv("PASSES")) : 40;
  std::map<std::string, std::map<std::string, int>> tally;
  for (int p = 0; p < passes; ++p) {
    const Orbit orbit = random_orbit(rng);
    const auto around = testing::seen_from(orbit, testing::spherical_horizon_km(40.0));
    const testing::SpinningBody body = testing::random_body(around, 8.0 * kDegree_rad, rng);
    const auto edges =
        testing::edges_between(body, around, 0.0, revs * 2.0 * kPi / body.rate_rad_s);
    const auto pulses =
        testing::pulses_from(edges, testing::kTransferStart, body.config.noise, rng);
    const double turn =
        angle_between_rad(around.earth_icrf_km(0.0), around.earth_icrf_km(revs * 1.0)) /
        kDegree_rad;
    for (const auto& [name, out] : lost) {
      std::vector<Pulse> some;
      for (auto& q : pulses)
        if (!out.contains(q.channel)) some.push_back(q);
      const SpinOutput output = testing::run(SpinPass{body.config, orbit}, some);
      auto& t = tally[name];
      if (std::getenv("P") && atoi(std::getenv("P")) == p && name == std::getenv("C")) {
        int k = 0;
        for (auto& f : testing::all_of<SpinFix>(output)) {
          if (k++ % 20 > 0 && k > 3) continue;
          std::printf("  fix %ld off %.3f s %.3f norm %.4f alts:", long(f.revolution),
                      angle_between_rad(f.axis_icrf, body.axis_icrf) / kDegree_rad,
                      std::sqrt(f.covariance_rad2.trace()) / kDegree_rad, f.norm);
          for (auto& a : f.alternate_axes_icrf)
            std::printf(" %.3f", angle_between_rad(a, body.axis_icrf) / kDegree_rad);
          std::printf("\n");
        }
        k = 0;
        for (auto& e : testing::all_of<SpinEstimate>(output)) {
          if (k++ % 20 > 0 && k > 8) continue;
          std::printf("  est %d off %.3f s %.3f %s\n", k,
                      angle_between_rad(e.axis_icrf, body.axis_icrf) / kDegree_rad,
                      testing::sigma_rad(e) / kDegree_rad, e.status.c_str());
        }
      }
      std::map<std::int64_t, SpinFix> last;
      for (auto& f : testing::all_of<SpinFix>(output)) last.insert_or_assign(f.revolution, f);
      int acc = 0, wrong = 0, wrongprior = 0;
      std::map<Resolution, int> res;
      for (auto& [n, f] : last) {
        ++res[f.resolution];
        if (!f.accepted) continue;
        ++acc;
        const double off = angle_between_rad(f.axis_icrf, body.axis_icrf);
        const double sig = std::sqrt(f.covariance_rad2.trace());
        if (off > 5.0 * sig) {
          ++wrong;
          if (f.resolution == Resolution::Prior) ++wrongprior;
        }
      }
      int est = 0, ok = 0, okwrong = 0, meanwrong = 0, means = 0;
      std::string st = "-";
      double off_end = -1, sig_end = -1, off_m = -1, sig_m = -1;
      for (auto& e : testing::all_of<SpinEstimate>(output)) {
        const double off = angle_between_rad(e.axis_icrf, body.axis_icrf);
        const double sig = testing::sigma_rad(e);
        if (e.estimator == SpinEstimator::Mean) {
          ++means;
          off_m = off;
          sig_m = sig;
          if (off > 5 * sig) ++meanwrong;
          continue;
        }
        ++est;
        st = e.status;
        off_end = off;
        sig_end = sig;
        if (e.status.starts_with("OK")) {
          ++ok;
          if (off > 5 * sig) ++okwrong;
        }
      }
      t["passes"]++;
      t["accepted"] += acc > 0;
      t["wrongfix"] += wrong > 0;
      t["ok"] += ok > 0;
      t["okwrong"] += okwrong > 0;
      t["meanwrong"] += meanwrong > 0;
      t["none"] += est == 0;
      t["end " + st.substr(0, st.find(','))]++;
      if (wrong || okwrong || meanwrong || std::getenv("V"))
        std::printf(
            "p%d case %s turn %.1f fixes %zu acc %d wrong %d (prior %d) [G%d C%d P%d D%d A%d] est "
            "%d ok %d okwrong %d means %d wrong %d (%.3f s %.3f) end %s off %.3f s %.3f\n",
            p, name.c_str(), turn, last.size(), acc, wrong, wrongprior, res[Resolution::Geometry],
            res[Resolution::Constraint], res[Resolution::Prior], res[Resolution::Dispersion],
            res[Resolution::Ambiguous], est, ok, okwrong, means, meanwrong, off_m / kDegree_rad,
            sig_m / kDegree_rad, st.c_str(), off_end / kDegree_rad, sig_end / kDegree_rad);
    }
  }
  for (auto& [n, t] : tally) {
    std::printf("%s:", n.c_str());
    for (auto& [k, v] : t) std::printf(" %s=%d", k.c_str(), v);
    std::printf("\n");
  }
}
}  // namespace
}  // namespace spindrift
