#include "tests/support/three_axis_files.h"

#include <fmt/format.h>

#include <fstream>
#include <random>
#include <string>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/geomagnetism/main_field.h"
#include "services/mission/igrf.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing {
namespace {

// Indices of the wrong star fix and of the saturated gyro sample.
constexpr int kWrongStar = 3;
constexpr int kSaturatedGyro = 70;

std::string mission_toml(const ThreeAxisConfig& config) {
  const auto& q = config.star_tracker->q_body_sensor;
  return fmt::format(
      "[spacecraft]\nid = \"SAT\"\nkind = \"three_axis\"\n"
      "[three_axis.gyro]\nnoise_deg_s = {}\nbias_sigma_deg_s = {}\nrange_deg_s = {}\n"
      "[three_axis.sun_sensor]\nnoise_deg = {}\n"
      "[three_axis.star_tracker]\nq_body_sensor = [{}, {}, {}, {}]\nnoise_arcsec = {}\n"
      "[three_axis.magnetometer]\nnoise_nt = {}\n",
      config.gyro->noise_rad_s / kRadPerDeg, config.gyro->bias_sigma_rad_s / kRadPerDeg,
      *config.gyro->range_rad_s / kRadPerDeg, config.sun_sensor->noise_rad / kRadPerDeg, q.x(),
      q.y(), q.z(), q.w(), config.star_tracker->noise_rad / kRadPerDeg * 3600.0,
      config.magnetometer->noise_nt);
}

/// Writes a CSV file with a row `row(t_s, number)` every `step_s`.
template <class Row>
void write_rows(const std::filesystem::path& file, const char* columns, double from_s, double to_s,
                double step_s, const Row& row) {
  std::ofstream csv{file};
  csv << "t_tai_ns," << columns << '\n';
  for (int number = 0; from_s + number * step_s < to_s; ++number) {
    const double t_s = from_s + number * step_s;
    csv << tai_ns(at_s(t_s)) << row(t_s, number) << '\n';
  }
}

std::string fields(const Eigen::Vector3d& v) {
  return fmt::format(",{},{},{}", v.x(), v.y(), v.z());
}

}  // namespace

void write_three_axis_pass(const std::filesystem::path& folder, const ThreeAxisScene& scene) {
  std::mt19937_64 rng{22};
  ThreeAxisConfig config = usual_three_axis();
  config.magnetometer = Magnetometer{.noise_nt = 100.0};
  const TurningBody body = TurningBody::smooth(rng, scene.duration_s + 1.0, 0.02);
  Sensors sensors{body, config, rng};
  std::ofstream{folder / "mission.toml"}
      << mission_toml(config)
      << (scene.separation ? fmt::format("[reconstruction]\nt1_tai_ns = {}\n", tai_ns(at_s(-60.0)))
                           : "");
  if (scene.commanded_deg) {
    const Eigen::Quaterniond q =
        body.q_icrf_body(0.0) *
        Eigen::AngleAxisd{*scene.commanded_deg * kRadPerDeg, Eigen::Vector3d::UnitX()};
    std::ofstream{folder / "mission.toml", std::ios::app} << fmt::format(
        "[three_axis.nominal]\nq_icrf_body = [{}, {}, {}, {}]\n", q.x(), q.y(), q.z(), q.w());
  }

  const double end_s = scene.duration_s;
  write_rows(folder / "gyro.csv", "wx_rad_s,wy_rad_s,wz_rad_s", 0.0, end_s, scene.gyro_s,
             [&](double t_s, int number) {
               const Eigen::Vector3d rate_rad_s = sensors.gyro(t_s).rate_body_rad_s;
               return fields(number == kSaturatedGyro ? Eigen::Vector3d::Constant(1.0).eval()
                                                      : rate_rad_s);
             });
  write_rows(folder / "star.csv", "qx,qy,qz,qw", 1.0, end_s, scene.star_s,
             [&](double t_s, int number) {
               const Eigen::Quaterniond true_q = sensors.star(t_s).q_icrf_sensor;
               const Eigen::Quaterniond q =
                   number == kWrongStar ? true_q * Eigen::Quaterniond{0.6, 0.0, 0.8, 0.0} : true_q;
               return fmt::format(",{},{},{},{}", q.x(), q.y(), q.z(), q.w());
             });
  const Eigen::Vector3d sun_icrf = -earth_motion(at_s(0.0)).heliocentric_icrf_km.normalized();
  write_rows(folder / "sun.csv", "sx,sy,sz", 0.0, end_s, scene.sun_s, [&](double t_s, int) {
    return fields(sensors.direction(t_s, sun_icrf, config.sun_sensor->noise_rad));
  });
  // The spacecraft is between Earth and Sun, so that it is never in eclipse.
  const Eigen::Vector3d position_km = 7000.0 * sun_icrf;
  const auto orbit = KeplerOrbit::through(
      at_s(0.0),
      {.position_icrf_km = position_km, .velocity_icrf_km_s = 7.5 * position_km.unitOrthogonal()});
  write_rows(folder / "orbit_state.csv", "x_km,y_km,z_km,vx_km_s,vy_km_s,vz_km_s", 0.0, end_s, 20.0,
             [&](double t_s, int) {
               const OrbitState state = orbit->at(at_s(t_s)).value();
               return fields(state.position_icrf_km) + fields(state.velocity_icrf_km_s);
             });
  const MainFieldModel model = igrf().value();
  TurningEarth earth;
  write_rows(
      folder / "magnetometer.csv", "bx_nt,by_nt,bz_nt", 0.0, end_s, scene.sun_s,
      [&](double t_s, int) {
        const OrbitState state = orbit->at(at_s(t_s)).value();
        return fields(
            sensors
                .field(t_s, field_icrf_nt(model, at_s(t_s), state.position_icrf_km, earth).value())
                .field_body_nt);
      });
}

void write_half(const std::filesystem::path& pass, std::int64_t middle_tai_ns, bool first,
                const std::filesystem::path& to) {
  for (const char* name :
       {"gyro.csv", "star.csv", "sun.csv", "orbit_state.csv", "magnetometer.csv"}) {
    std::ifstream whole{pass / name};
    std::ofstream half{to / name};
    std::string row;
    std::getline(whole, row);
    half << row << '\n';
    while (std::getline(whole, row)) {
      if ((std::stoll(row) < middle_tai_ns) == first) {
        half << row << '\n';
      }
    }
  }
}

}  // namespace spindrift::testing
