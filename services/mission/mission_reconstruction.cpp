#include "services/mission/mission_reconstruction.h"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <vector>

#include "services/mission/values.h"

namespace spindrift {
namespace {

std::optional<TaiTime> time_if(const TomlValues& values, std::string_view key) {
  const auto t_tai_ns = value_if<std::int64_t>(values, key);
  return t_tai_ns ? std::optional{tai_from_ns(*t_tai_ns)} : std::nullopt;
}

Euler312 angles_of(const std::vector<double>& deg) {
  return {.phi_rad = deg.at(0) * kRadPerDeg,
          .theta_rad = deg.at(1) * kRadPerDeg,
          .psi_rad = deg.at(2) * kRadPerDeg};
}

/// Returns empty and adds the problems when a key is missing.
std::optional<Launch> launch(TomlDocument& document) {
  const TomlValues& values = document.values;
  static constexpr std::array<std::string_view, 4> kKeys = {
      "reconstruction.launcher.site_lat_deg", "reconstruction.launcher.site_lon_deg",
      "reconstruction.launcher.launch_azimuth_deg", "reconstruction.launcher.epoch_tai_ns"};
  bool complete = true;
  for (const std::string_view key : kKeys) {
    if (!values.contains(key)) {
      complete = false;
      add_problem(document, "reconstruction.launcher",
                  fmt::format("{}: missing: euler312_launch_deg needs it", key));
    }
  }
  return complete ? std::optional{Launch{.site = {.latitude_rad = radians(values, kKeys[0]),
                                                  .longitude_rad = radians(values, kKeys[1])},
                                         .azimuth_rad = radians(values, kKeys[2]),
                                         .epoch = *time_if(values, kKeys[3])}}
                  : std::nullopt;
}

std::optional<LauncherAttitude> launcher(TomlDocument& document) {
  const TomlValues& values = document.values;
  const auto sigma_rad = radians_if(values, "reconstruction.launcher.sigma_deg");
  if (!sigma_rad) {
    return std::nullopt;
  }
  using Angles = std::vector<double>;
  if (const auto deg = value_if<Angles>(values, "reconstruction.launcher.euler312_deg")) {
    return LauncherAttitude{.told = InOrbitFrame{angles_of(*deg)}, .sigma_rad = *sigma_rad};
  }
  const auto deg = value_of<Angles>(values, "reconstruction.launcher.euler312_launch_deg");
  const auto from = launch(document);
  return from ? std::optional{LauncherAttitude{
                    .told = InLaunchFrame{.angles = angles_of(deg), .launch = *from},
                    .sigma_rad = *sigma_rad}}
              : std::nullopt;
}

}  // namespace

std::optional<SeparationPlan> separation_plan(TomlDocument& document) {
  const TomlValues& values = document.values;
  const auto separation = time_if(values, "reconstruction.t1_tai_ns");
  if (!separation) {
    return std::nullopt;
  }
  return SeparationPlan{
      .times = {.separation = *separation,
                .control_on = time_if(values, "reconstruction.t2_tai_ns"),
                .acquisition = time_if(values, "reconstruction.t3_tai_ns"),
                .first_star_fix = time_if(values, "reconstruction.t4_tai_ns")},
      .launcher = launcher(document),
      .disturbance_rad_s2 =
          radians_if(values, "reconstruction.disturbance_deg_s2").value_or(kDisturbance_rad_s2)};
}

}  // namespace spindrift
