#include "services/field_tables/table_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <iterator>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ephemeris/flight_frames.h"

namespace spindrift {

namespace embedded {
extern const char* const on_board_anomaly;
extern const char* const on_board_uniform;
extern const char* const on_board_curvature;
extern const char* const on_board_chebyshev;
}  // namespace embedded

namespace {

// Rate of the Earth rotation angle, IERS Conventions 2010, table 1.2.
constexpr double kEarthRate_rad_s = 7.292115e-5;

const char* lookup_of(TableKind kind) {
  switch (kind) {
    case TableKind::Uniform:
      return embedded::on_board_uniform;
    case TableKind::Curvature:
      return embedded::on_board_curvature;
    case TableKind::Chebyshev:
      break;
  }
  return embedded::on_board_chebyshev;
}

/// Returns text that does not end a comment of C, or begin one.
std::string in_comment(std::string_view text) {
  std::string plain{text};
  std::replace(plain.begin(), plain.end(), '*', '_');
  std::replace(plain.begin(), plain.end(), '\\', '_');
  return plain;
}

/// @param unit Unit vector in the axes of the Earth at the epoch.
std::string vector_text(std::string_view name, const Eigen::Vector3d& unit) {
  return fmt::format("static const double field_table_{}[3] = {{{:.17e}, {:.17e}, {:.17e}}};\n",
                     name, unit.x(), unit.y(), unit.z());
}

std::string rows_text(const FieldTable& table) {
  std::string text =
      fmt::format("static const float field_table_nt[{}][3] = {{\n", table.rows.size());
  for (const Eigen::Vector3f& row : table.rows) {
    fmt::format_to(std::back_inserter(text), "    {{{:.9e}f, {:.9e}f, {:.9e}f}},\n", row.x(),
                   row.y(), row.z());
  }
  text += "};\n";
  if (!table.knots_rad.empty()) {
    fmt::format_to(std::back_inserter(text), "static const float field_table_knots_rad[{}] = {{\n",
                   table.knots_rad.size());
    for (const float knot_rad : table.knots_rad) {
      fmt::format_to(std::back_inserter(text), "    {:.9e}f,\n", knot_rad);
    }
    text += "};\n";
  }
  return text;
}

std::string constants_text(const FieldTable& table, const KeplerOrbit& orbit) {
  return fmt::format(
      "#define FIELD_TABLE_ROWS {}\n"
      "#define FIELD_TABLE_FIRST_ANOMALY_RAD {:.17e}\n"
      "#define FIELD_TABLE_EARTH_RATE_RAD_S {:.17e}\n"
      "#define FIELD_TABLE_ECCENTRICITY {:.17e}\n"
      "#define FIELD_TABLE_MEAN_ANOMALY_RAD {:.17e}\n"
      "#define FIELD_TABLE_MEAN_MOTION_RAD_S {:.17e}\n",
      table.rows.size(), orbit.true_anomaly_at_epoch_rad(), kEarthRate_rad_s, orbit.eccentricity(),
      orbit.mean_anomaly_at_epoch_rad(), orbit.mean_motion_rad_s());
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Returns a name that names in C may begin with.
std::string c_name(std::string_view name) {
  std::string plain{name};
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return !is_letter(c) && !(c >= '0' && c <= '9'); },
      '_');
  return !plain.empty() && is_letter(plain.front()) ? plain : "field_" + plain;
}

/// Names all in the header by its own name.
std::string named(std::string code, std::string_view name) {
  const std::string prefix = c_name(name);
  boost::replace_all(code, "field_table", prefix);
  boost::replace_all(code, "FIELD_TABLE", boost::to_upper_copy(prefix));
  return code;
}

}  // namespace

Expected<std::string> header_of(const FieldTable& table, const KeplerOrbit& orbit,
                                const HeaderTexts& texts, double later_nt) {
  const TaiTime epoch = orbit.epoch();
  return orbit.at(epoch).and_then(orbit_frame).map([&](const Eigen::Quaterniond& q_icrf_orbit) {
    const Eigen::Quaterniond q_itrf_orbit = earth_orientation(epoch).conjugate() * q_icrf_orbit;
    return named(
        fmt::format("/* {}.\n"
                    "   Seconds count from the epoch, {} ns of TAI since 1970. The table is of the "
                    "revolution from there on: one\n"
                    "   revolution later, when the Earth has turned, the field at the same anomaly "
                    "is {:.0f} nT off on average.\n"
                    "   Made by spindrift geomag table. */\n"
                    "#ifndef FIELD_TABLE_H\n#define FIELD_TABLE_H\n\n#include <math.h>\n\n"
                    "#ifdef __clang__\n#pragma clang diagnostic push\n"
                    "#pragma clang diagnostic ignored \"-Wunused-function\"\n#endif\n\n{}\n"
                    "/* Directions to the first position, and ahead of it in the plane of the "
                    "orbit, in the axes of the Earth at the epoch. */\n"
                    "{}{}\n{}{}{}\n"
                    "#ifdef __clang__\n#pragma clang diagnostic pop\n#endif\n\n#endif\n",
                    in_comment(texts.made_of), tai_ns(epoch), later_nt,
                    constants_text(table, orbit),
                    vector_text("first", q_itrf_orbit * -Eigen::Vector3d::UnitZ()),
                    vector_text("ahead", q_itrf_orbit * Eigen::Vector3d::UnitX()), rows_text(table),
                    embedded::on_board_anomaly, lookup_of(table.kind)),
        texts.name);
  });
}

}  // namespace spindrift
