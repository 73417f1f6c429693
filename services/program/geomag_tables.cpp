#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/frames/angle.h"
#include "services/base/file_lines.h"
#include "services/base/input_file.h"
#include "services/base/json_line.h"
#include "services/base/warning.h"
#include "services/field_tables/study_report.h"
#include "services/field_tables/table_bytes.h"
#include "services/field_tables/table_header.h"
#include "services/mission/igrf.h"
#include "services/mission/mission.h"
#include "services/program/commands.h"
#include "services/program/outcome.h"
#include "services/program/points_file.h"
#include "services/simulation/output_file.h"
#include "services/telemetry/parse_row.h"

namespace spindrift {
namespace {

constexpr std::string_view kAnomaly = "anomaly_deg";
// At the surface the field has up to 67,000 nT.
constexpr double kStrongest_nt = 100'000.0;

/// The orbit of a mission and the field of a date.
struct OrbitAndField {
  std::string spacecraft_id;
  KeplerOrbit orbit;
  MainField field;
};

Expected<OrbitAndField> orbit_and_field(const std::filesystem::path& path, double year,
                                        int degree) {
  const auto mission = load_mission(path);
  if (!mission) {
    return Unexpected{mission.error()};
  }
  const KeplerOrbit* const orbit = mission->orbit ? mission->orbit->elements() : nullptr;
  if (orbit == nullptr) {
    return refused(
        fmt::format("{}: has no [orbit.elements]; a table of the field is of one "
                    "revolution of such an orbit",
                    shown(path.string())));
  }
  const auto field =
      igrf().and_then([&](const MainFieldModel& model) { return model.at(year, degree); });
  if (!field) {
    return refused(fmt::format("--date {} --degree {}: {}", year, degree, field.error().message));
  }
  return OrbitAndField{mission->spacecraft_id, *orbit, *field};
}

/// Refuses a file that would be written over another one that the command names.
Expected<void> are_apart(std::vector<std::filesystem::path> paths) {
  std::erase(paths, std::filesystem::path{});
  for (auto& path : paths) {
    path = std::filesystem::absolute(path).lexically_normal();
  }
  std::sort(paths.begin(), paths.end());
  const auto twice = std::adjacent_find(paths.begin(), paths.end());
  if (twice != paths.end()) {
    return refused(fmt::format("{}: --mission, --out and --header must be different files",
                               shown(twice->string())));
  }
  return {};
}

Expected<TableKind> kind_of(std::string_view name) {
  if (const auto kind = table_kind(name)) {
    return *kind;
  }
  return refused(
      fmt::format("--kind {}: must be uniform, curvature or chebyshev", shown(std::string{name})));
}

/// @return InvalidConfiguration naming the value and what is allowed.
Expected<double> anomaly_deg_of(const FileLine& line) {
  double deg = 0.0;
  if (auto reason = parse_field(kAnomaly, line.text, deg); !reason.empty()) {
    return refused(std::move(reason));
  }
  if (!(deg >= 0.0 && deg <= 360.0)) {
    return refused(fmt::format("{} = {}: must lie in [0, 360], behind the first", kAnomaly, deg));
  }
  return deg;
}

Unexpected no_field(const GeomagLookupOptions& options, double deg, double strength_nt) {
  return Unexpected{
      {ErrorCode::InvalidConfiguration,
       fmt::format("{}: gives {:.0f} nT at {} deg, more than the Earth's field has "
                   "anywhere, {:.0f} nT: of another kind than {}, or damaged",
                   shown(options.table.string()), strength_nt, deg, kStrongest_nt, options.kind)}};
}

Expected<FieldTable> table_in(const GeomagLookupOptions& options) {
  const auto kind = kind_of(options.kind);
  if (!kind) {
    return Unexpected{kind.error()};
  }
  return read_text_file(options.table).and_then([&](const std::string& bytes) {
    return table_of(bytes, *kind).map_error([&](const Error& error) {
      return Error{ErrorCode::InvalidConfiguration,
                   fmt::format("{}: {}", shown(options.table.string()), error.message)};
    });
  });
}

}  // namespace

Expected<void> geomag_table(const GeomagTableOptions& options) {
  if (auto apart = are_apart({options.mission, options.out, options.header}); !apart) {
    return apart;
  }
  const auto kind = kind_of(options.kind);
  if (!kind) {
    return Unexpected{kind.error()};
  }
  const auto of = orbit_and_field(options.mission, options.year, options.degree);
  if (!of) {
    return Unexpected{of.error()};
  }
  RevolutionField revolution{of->orbit, of->field};
  const auto table = make_table([&](double behind_rad) { return revolution.at(behind_rad); }, *kind,
                                of->orbit.true_anomaly_at_epoch_rad(), options.points);
  if (!table) {
    return refused(fmt::format("--points {}: {}", options.points, table.error().message));
  }
  const auto later_nt = revolution.off_a_revolution_later_nt();
  if (!later_nt) {
    return Unexpected{later_nt.error()};
  }
  auto written = write_file(options.out, bytes_of(*table));
  if (written && !options.header.empty()) {
    written =
        header_of(
            *table, of->orbit,
            {.made_of = fmt::format(
                 "{}: field along one revolution, {} of {} to degree {}, kind {}",
                 of->spacecraft_id, kFieldModelName, options.year, options.degree, name_of(*kind)),
             .name = options.header.stem().string()},
            *later_nt)
            .and_then([&](const std::string& text) { return write_file(options.header, text); });
  }
  return written.map([&] {
    if (options.json) {
      fmt::print("{}", json_line(with_warnings({{"kind", options.kind},
                                                {"points", options.points},
                                                {"bytes", table->bytes()},
                                                {"off_a_revolution_later_nt", *later_nt}})));
      return;
    }
    fmt::print(
        "{}: {} bytes, {} of {} points; a revolution later the field at the same anomaly is "
        "{:.0f} nT off on average\n",
        options.out.string(), table->bytes(), name_of(*kind), options.points, *later_nt);
  });
}

Expected<void> geomag_lookup(const GeomagLookupOptions& options) {
  const auto table = table_in(options);
  if (!table) {
    return Unexpected{table.error()};
  }
  std::string text = fmt::format("{},x_nt,y_nt,z_nt\n", kAnomaly);
  nlohmann::json points = nlohmann::json::array();
  return for_each_row(options.points, kAnomaly,
                      [&](const FileLine& line) {
                        return anomaly_deg_of(line).and_then([&](double deg) -> Expected<void> {
                          const Eigen::Vector3d field_nt = lookup(*table, deg * kRadPerDeg);
                          if (field_nt.norm() > kStrongest_nt) {
                            return no_field(options, deg, field_nt.norm());
                          }
                          fmt::format_to(std::back_inserter(text), "{},{:.4f},{:.4f},{:.4f}\n", deg,
                                         field_nt.x(), field_nt.y(), field_nt.z());
                          points.push_back({{"anomaly_deg", deg},
                                            {"x_nt", field_nt.x()},
                                            {"y_nt", field_nt.y()},
                                            {"z_nt", field_nt.z()}});
                          return {};
                        });
                      })
      .map([&] {
        fmt::print("{}",
                   options.json ? json_line(with_warnings({{"points", std::move(points)}})) : text);
      });
}

Expected<void> geomag_study(const GeomagStudyOptions& options) {
  const auto study =
      orbit_and_field(options.mission, options.year, options.degree)
          .and_then([](const OrbitAndField& of) { return study_tables(of.orbit, of.field); });
  if (!study) {
    return Unexpected{study.error()};
  }
  for (const auto& [name, svg] : plots_of(*study)) {
    if (auto written = write_file(options.out / name, svg); !written) {
      return written;
    }
  }
  fmt::print("{}", options.json ? json_line(with_warnings(to_json(*study))) : to_text(*study));
  return {};
}

}  // namespace spindrift
