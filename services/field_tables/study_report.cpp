#include "services/field_tables/study_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "pipelines/frames/angle.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
constexpr std::array<const char*, 3> kAngles{"phi", "theta", "psi"};

nlohmann::json by_axis(const Vector3d& values, const std::array<const char*, 3>& names) {
  nlohmann::json json;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    json[names.at(static_cast<std::size_t>(axis))] = values[axis];
  }
  return json;
}

std::array<double, 3> elements_of(const Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

std::string errors_text(const Vector3d& errors_nt) {
  return fmt::format("{:>9.4f}", fmt::join(elements_of(errors_nt), " "));
}

std::string degrees_text(const Vector3d& angles_rad) {
  return fmt::format("{:.3f} deg", fmt::join(elements_of(kDegPerRad * angles_rad), ", "));
}

double best_weight(const FieldStudy& study) {
  return std::min_element(
             study.weights.begin(), study.weights.end(),
             [](const auto& a, const auto& b) { return a.mean_error_nt < b.mean_error_nt; })
      ->weight;
}

}  // namespace

std::string to_text(const FieldStudy& study) {
  std::string text =
      "kind       points  bytes     mean error x, y, z, nT       largest error x, y, z, nT     "
      "ARMSE "
      "of the attitude phi, theta, psi, deg\n";
  for (const StudiedTable& is : study.tables) {
    fmt::format_to(std::back_inserter(text), "{:<10} {:>6} {:>6}  {}  {}   {:.5f}\n",
                   name_of(is.kind), is.points, is.bytes, errors_text(is.errors.mean_nt),
                   errors_text(is.errors.most_nt),
                   fmt::join(elements_of(kDegPerRad * is.armse_rad), " "));
  }
  const MostOff& most = study.most;
  fmt::format_to(
      std::back_inserter(text),
      "\nAttitude from Sun and field over the revolution, largest errors of phi, theta, psi in all "
      "runs\n"
      "  with the field itself            {}\n"
      "  with the table of {} points     {}  (curvature, K = {:.2f})\n"
      "  the table's own share            {}\n"
      "Errors grow where Sun and field are nearly in line; left out are {} of {} places where they "
      "give no attitude.\n",
      degrees_text(most.with_field_rad), kChosenPoints, degrees_text(most.with_table_rad),
      best_weight(study), degrees_text(most.by_table_rad), study.places_in_line,
      study.places.size());
  return text;
}

nlohmann::json to_json(const FieldStudy& study) {
  nlohmann::json tables = nlohmann::json::array();
  for (const StudiedTable& is : study.tables) {
    tables.push_back({{"kind", name_of(is.kind)},
                      {"points", is.points},
                      {"bytes", is.bytes},
                      {"mean_error_nt", by_axis(is.errors.mean_nt, kAxes)},
                      {"largest_error_nt", by_axis(is.errors.most_nt, kAxes)},
                      {"armse_deg", by_axis(kDegPerRad * is.armse_rad, kAngles)}});
  }
  const MostOff& most = study.most;
  return {{"tables", std::move(tables)},
          {"curvature_weight", best_weight(study)},
          {"places_in_line", study.places_in_line},
          {"largest_attitude_error_deg",
           {{"with_field", by_axis(kDegPerRad * most.with_field_rad, kAngles)},
            {"with_table", by_axis(kDegPerRad * most.with_table_rad, kAngles)},
            {"by_table", by_axis(kDegPerRad * most.by_table_rad, kAngles)}}}};
}

}  // namespace spindrift
