#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/local_frame.h"
#include "services/base/file_lines.h"
#include "services/base/json_line.h"
#include "services/base/warning.h"
#include "services/mission/igrf.h"
#include "services/program/commands.h"
#include "services/program/outcome.h"
#include "services/program/points_file.h"
#include "services/telemetry/csv.h"
#include "services/telemetry/parse_row.h"

namespace spindrift {
namespace {

constexpr std::string_view kHeader = "lat_deg,lon_deg,height_km";

struct PointColumn {
  std::string_view name;
  double least;
  double most;
};
constexpr std::array kColumns = {PointColumn{"lat_deg", -90.0, 90.0},
                                 PointColumn{"lon_deg", -360.0, 360.0},
                                 PointColumn{"height_km", -100.0, 1e6}};

/// Values in the order of kColumns.
using Point = std::array<double, kColumns.size()>;

struct FieldAtPoint {
  Point point;
  Eigen::Vector3d ned_nt;
};

/// @return InvalidConfiguration naming column, field and what is allowed.
Expected<Point> point_of(const FileLine& line) {
  const CsvFields fields{line.text};
  if (line.too_long || fields.count() != kColumns.size()) {
    return refused(fmt::format("row {}: must be {}", quoted(line.text), kHeader));
  }
  Point point{};
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const auto& [name, least, most] = kColumns.at(i);
    if (auto reason = parse_field(name, fields.fields()[i], point.at(i)); !reason.empty()) {
      return refused(std::move(reason));
    }
    if (!(point.at(i) >= least && point.at(i) <= most)) {
      return refused(fmt::format("{} = {}: must lie in [{}, {}]", name, point.at(i), least, most));
    }
  }
  return point;
}

Expected<FieldAtPoint> field_at(const MainField& field, const Point& point) {
  const auto& [lat_deg, lon_deg, height_km] = point;
  return local_frame(GeodeticPlace{.latitude_rad = lat_deg * kRadPerDeg,
                                   .longitude_rad = lon_deg * kRadPerDeg,
                                   .height_km = height_km})
      .and_then([&](const LocalFrame& frame) { return field.ned_at(frame); })
      .map([&](const Eigen::Vector3d& ned_nt) {
        return FieldAtPoint{point, ned_nt};
      });
}

/// Returns the field at all points of the file, or the error of the first bad line.
Expected<std::vector<FieldAtPoint>> fields_at(const std::filesystem::path& path,
                                              const MainField& field) {
  std::vector<FieldAtPoint> fields;
  return for_each_row(path, kHeader,
                      [&](const FileLine& line) {
                        return point_of(line)
                            .and_then([&](const Point& point) { return field_at(field, point); })
                            .map([&](const FieldAtPoint& at) { fields.push_back(at); });
                      })
      .map([&] { return std::move(fields); });
}

std::string to_text(const std::vector<FieldAtPoint>& fields) {
  std::string text = fmt::format("{},north_nt,east_nt,down_nt\n", kHeader);
  for (const auto& [point, ned_nt] : fields) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{:.2f},{:.2f},{:.2f}\n", point[0], point[1],
                   point[2], ned_nt.x(), ned_nt.y(), ned_nt.z());
  }
  return text;
}

nlohmann::json to_json(double year, const std::vector<FieldAtPoint>& fields) {
  nlohmann::json points = nlohmann::json::array();
  for (const auto& [point, ned_nt] : fields) {
    points.push_back({{"lat_deg", point[0]},
                      {"lon_deg", point[1]},
                      {"height_km", point[2]},
                      {"north_nt", ned_nt.x()},
                      {"east_nt", ned_nt.y()},
                      {"down_nt", ned_nt.z()}});
  }
  return {{"date", year}, {"model", kFieldModelName}, {"points", std::move(points)}};
}

}  // namespace

Expected<void> geomag_field(const GeomagFieldOptions& options) {
  const auto field =
      igrf().and_then([&](const MainFieldModel& model) { return model.at(options.year); });
  if (!field) {
    return refused(fmt::format("--date {}: {}", options.year, field.error().message));
  }
  return fields_at(options.points, *field).map([&](const std::vector<FieldAtPoint>& fields) {
    fmt::print("{}", options.json ? json_line(with_warnings(to_json(options.year, fields)))
                                  : to_text(fields));
  });
}

}  // namespace spindrift
