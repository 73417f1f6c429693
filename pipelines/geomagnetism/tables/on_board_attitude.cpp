#include "pipelines/geomagnetism/tables/on_board_attitude.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "pipelines/ephemeris/flight_frames.h"
#include "pipelines/frames/angle.h"
#include "pipelines/geomagnetism/tables/revolution_field.h"
#include "pipelines/three_axis/attitude_from_vectors.h"

namespace spindrift {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr TaiTime kJ2000{std::chrono::days{10957} + std::chrono::hours{12}};
constexpr double kCentury_s = 36525.0 * 86400.0;
constexpr double kObliquity_rad = 23.43929111 * kRadPerDeg;

/// Returns where the table is read: by the motion from the epoch on (Liu 2019, eq. 5), and in later
/// revolutions again from its beginning.
double place_in_table_rad(const KeplerOrbit& orbit, TaiTime t) {
  const double behind_rad = orbit.true_anomaly_behind_epoch_rad(t);
  return behind_rad <= kTurn_rad ? behind_rad : std::fmod(behind_rad, kTurn_rad);
}

/// The computer of one satellite.
class OnBoardComputer {
 public:
  explicit OnBoardComputer(const OnBoardModel& model) : model_{model} {}

  Expected<OnBoardAttitude> attitude(TaiTime t, const SunAndField& body) {
    const auto here = model_.orbit.at(t);
    const auto q_icrf_orbit = here.and_then(orbit_frame);
    if (!q_icrf_orbit) {
      return Unexpected{q_icrf_orbit.error()};
    }
    const Vector3d sun_orbit = q_icrf_orbit->conjugate() * sun_by_formula_icrf(t);
    const auto with = [&](const Vector3d& field_nt) {
      return two_vector_attitude(body, {.sun = sun_orbit, .field_nt = field_nt});
    };
    const Vector3d by_table_nt = lookup(model_.table, place_in_table_rad(model_.orbit, t));
    return with(by_table_nt).and_then([&](const Quaterniond& by_table) {
      return field_orbit_nt(model_.field, *here, earth_.orientation(t))
          .and_then(with)
          .map([&](const Quaterniond& by_field) {
            return OnBoardAttitude{.t = t,
                                   .q_icrf_body = *q_icrf_orbit * by_table,
                                   .q_icrf_body_with_field = *q_icrf_orbit * by_field};
          });
    });
  }

 private:
  const OnBoardModel& model_;
  TurningEarth earth_;
};

}  // namespace

Expected<Quaterniond> two_vector_attitude(const SunAndField& body, const SunAndField& orbit) {
  return triad({.body = body.sun, .ref = orbit.sun, .sigma_rad = kStudySunNoise},
               {.body = body.field_nt,
                .ref = orbit.field_nt,
                .sigma_rad = kStudyFieldNoise_nt / orbit.field_nt.norm()})
      .map([](const UncertainAttitude& attitude) { return attitude.q_ref_body; });
}

Vector3d sun_by_formula_icrf(TaiTime t) {
  const double centuries = seconds_between(kJ2000, t) / kCentury_s;
  const double anomaly_rad = (357.5291 + 35999.0503 * centuries) * kRadPerDeg;
  const double longitude_rad = (280.4665 + 35999.3729 * centuries + 1.9146 * std::sin(anomaly_rad) +
                                0.0200 * std::sin(2.0 * anomaly_rad)) *
                               kRadPerDeg;
  return {std::cos(longitude_rad), std::sin(longitude_rad) * std::cos(kObliquity_rad),
          std::sin(longitude_rad) * std::sin(kObliquity_rad)};
}

Expected<std::vector<OnBoardAttitude>> on_board_attitudes(
    const OnBoardModel& model, const std::vector<SunDirection>& suns,
    const std::vector<MagneticField>& fields) {
  OnBoardComputer computer{model};
  std::vector<OnBoardAttitude> attitudes;
  auto field = fields.begin();
  for (const SunDirection& sun : suns) {
    field = std::find_if(field, fields.end(), [&](const auto& is) { return is.t >= sun.t; });
    if (field == fields.end() || field->t != sun.t) {
      continue;
    }
    auto attitude =
        computer.attitude(sun.t, {.sun = sun.sun_body, .field_nt = field->field_body_nt});
    if (attitude) {
      attitudes.push_back(*attitude);
    } else if (attitude.error().code != ErrorCode::Unobservable) {
      return Unexpected{attitude.error()};
    }
  }
  return attitudes;
}

}  // namespace spindrift
