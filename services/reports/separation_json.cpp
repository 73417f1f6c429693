#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "pipelines/time/utc.h"
#include "services/base/assessment_words.h"
#include "services/base/degrees.h"
#include "services/base/reasons_json.h"
#include "services/reports/separation_report.h"

namespace spindrift {
namespace {

using nlohmann::json;

json degrees_of(const Euler312& angles) {
  return {angles.phi_rad * kDegPerRad, angles.theta_rad * kDegPerRad, angles.psi_rad * kDegPerRad};
}

json deg_or_null(const std::optional<double>& angle_rad) {
  return angle_rad ? json(*angle_rad * kDegPerRad) : json{};
}

json vector_deg(const Eigen::Vector3d& rad) {
  return {rad.x() * kDegPerRad, rad.y() * kDegPerRad, rad.z() * kDegPerRad};
}

json matrix_deg2(const Eigen::Matrix3d& rad2) {
  json rows = json::array();
  for (int row = 0; row < 3; ++row) {
    rows.push_back(vector_deg(rad2.row(row).transpose() * kDegPerRad));
  }
  return rows;
}

json to_json(const ReconstructedEvent& event) {
  const ReconstructedAttitude& attitude = event.attitude;
  const Euler312Reading reading = euler312_of(attitude.q_icrf_body);
  return {{"event", name_of(event.event)},
          {"t_tai_ns", tai_ns(attitude.t)},
          {"utc", format_utc(attitude.t)},
          {"found", event.found},
          {"qx", attitude.q_icrf_body.x()},
          {"qy", attitude.q_icrf_body.y()},
          {"qz", attitude.q_icrf_body.z()},
          {"qw", attitude.q_icrf_body.w()},
          {"rate_deg_s", vector_deg(attitude.rate_body_rad_s)},
          {"euler312_icrf_deg", degrees_of(reading.angles)},
          {"near_singular", reading.near_singular},
          {"euler312_orbit_deg", nullptr},
          {"sigma_deg", attitude.sigma_rad() * kDegPerRad},
          {"noise_sigma_deg", attitude.noise_sigma_rad() * kDegPerRad},
          {"covariance_deg2", matrix_deg2(attitude.covariance_rad2)},
          {"bound_deg", deg_or_null(event.bound_rad)}};
}

json to_json(const OpenBiasDirection& open) {
  return {{"axis_body", {open.axis_body.x(), open.axis_body.y(), open.axis_body.z()}},
          {"sigma_deg_s", open.sigma_rad_s * kDegPerRad},
          {"share", open.share},
          {"off_sun_deg", deg_or_null(open.off_sun_rad)}};
}

json to_json(const SensorResiduals& sensor) {
  return {{"count", sensor.count},
          {"outliers", sensor.outliers},
          {"noise", sensor.noise ? json(*sensor.noise) : json{}}};
}

json to_json(const Expected<LauncherCheck>& check) {
  if (!check) {
    return {{"error", check.error().message}};
  }
  return {{"angle_deg", check->difference.angle_rad * kDegPerRad},
          {"chi_square", check->difference.chi_square},
          {"chance", check->chance},
          {"inside", check->chance >= kLeastChance}};
}

json to_json(const ReconstructedSeparation& separation) {
  const Reconstruction& solution = separation.solution;
  json object{{"quality", name_of(solution.assessment.quality)},
              {"reasons", json::parse(to_json_text(solution.assessment.reasons))},
              {"status", sentence_of(solution.assessment)},
              {"events", json::array()},
              {"attitudes", solution.history.size()},
              {"gyro_bias_deg_s", nullptr},
              {"gyro_bias_sigma_deg_s", nullptr},
              {"open_bias", json::array()},
              {"sun_misalignment_deg", nullptr},
              {"sun_misalignment_sigma_deg", nullptr},
              {"gyro", to_json(solution.gyro)},
              {"sun", to_json(solution.sun)},
              {"star", to_json(solution.star)},
              {"iterations", solution.iterations},
              {"launcher", nullptr}};
  for (std::size_t i = 0; i < solution.events.size(); ++i) {
    json event = to_json(solution.events[i]);
    if (i < separation.in_orbit_frame.size() && separation.in_orbit_frame[i]) {
      event["euler312_orbit_deg"] = degrees_of(separation.in_orbit_frame[i]->angles);
    }
    object["events"].push_back(std::move(event));
  }
  if (solution.bias) {
    object["gyro_bias_deg_s"] = vector_deg(solution.bias->rad_s);
    object["gyro_bias_sigma_deg_s"] =
        vector_deg(solution.bias->covariance_rad2_s2.diagonal().cwiseSqrt());
  }
  for (const OpenBiasDirection& open : solution.open_bias) {
    object["open_bias"].push_back(to_json(open));
  }
  if (solution.misalignment) {
    object["sun_misalignment_deg"] = vector_deg(solution.misalignment->vector_rad);
    object["sun_misalignment_sigma_deg"] =
        vector_deg(solution.misalignment->covariance_rad2.diagonal().cwiseSqrt());
  }
  if (separation.launcher) {
    object["launcher"] = to_json(*separation.launcher);
  }
  return object;
}

}  // namespace

nlohmann::json to_json(const SeparationReport& report) {
  json object{{"spacecraft", report.spacecraft_id},
              {"run_id", report.run_id},
              {"batch", nullptr},
              {"sequential", nullptr}};
  for (const ReconstructionProduct& product : report.methods) {
    object[std::string{name_of(product->solution.method)}] = to_json(*product);
  }
  return object;
}

}  // namespace spindrift
