#include "pipelines/geomagnetism/tables/field_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "pipelines/geomagnetism/tables/chebyshev_fit.h"
#include "pipelines/geomagnetism/tables/curvature_knots.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

double anomaly_of(Eigen::Index sample, Eigen::Index samples) {
  return kTurn_rad * static_cast<double>(sample) / static_cast<double>(samples - 1);
}

Expected<FieldTable> chebyshev_table(const FieldAlong& field, double first_anomaly_rad,
                                     int points) {
  return chebyshev_coefficients(field, points).map([&](const Eigen::MatrixX3d& coefficients) {
    FieldTable table{.kind = TableKind::Chebyshev,
                     .first_anomaly_rad = static_cast<float>(first_anomaly_rad)};
    for (const auto& row : coefficients.rowwise()) {
      table.rows.emplace_back(row.transpose().cast<float>());
    }
    return table;
  });
}

Expected<FieldTable> table_at(const FieldAlong& field, FieldTable table,
                              const std::vector<double>& knots_rad) {
  for (const double knot_rad : knots_rad) {
    const auto field_nt = field(knot_rad);
    if (!field_nt) {
      return Unexpected{field_nt.error()};
    }
    table.rows.emplace_back(field_nt->cast<float>());
  }
  return table;
}

Expected<FieldTable> uniform_table(const FieldAlong& field, double first_anomaly_rad, int points) {
  std::vector<double> knots_rad;
  for (int i = 0; i < points; ++i) {
    knots_rad.push_back(anomaly_of(i, points));
  }
  return table_at(
      field,
      {.kind = TableKind::Uniform, .first_anomaly_rad = static_cast<float>(first_anomaly_rad)},
      knots_rad);
}

/// Evaluates the field at the knots as they are stored.
Expected<FieldTable> curvature_table(const FieldAlong& field, double first_anomaly_rad,
                                     int points) {
  return sampled(field).and_then([&](const SampledField& field_nt) {
    FieldTable table{.kind = TableKind::Curvature,
                     .first_anomaly_rad = static_cast<float>(first_anomaly_rad)};
    const std::vector<double> places = curvature_knots(field_nt, points).places;
    std::vector<double> stored_rad;
    for (const double place : places) {
      table.knots_rad.push_back(static_cast<float>(kTurn_rad * place));
      stored_rad.push_back(std::min(static_cast<double>(table.knots_rad.back()), kTurn_rad));
    }
    return table_at(field, std::move(table), stored_rad);
  });
}

Vector3d between(const FieldTable& table, std::size_t i, double share) {
  return (1.0 - share) * table.rows[i].cast<double>() + share * table.rows[i + 1].cast<double>();
}

Vector3d lookup_uniform(const FieldTable& table, double behind_first_rad) {
  const auto last = static_cast<double>(table.rows.size() - 1);
  const double place = behind_first_rad / kTurn_rad * last;
  const double i = std::min(std::floor(place), last - 1.0);
  return between(table, static_cast<std::size_t>(i), place - i);
}

Vector3d lookup_curvature(const FieldTable& table, double behind_first_rad) {
  const auto& knots = table.knots_rad;
  const auto above =
      std::upper_bound(knots.begin() + 1, knots.end() - 1, static_cast<float>(behind_first_rad));
  const auto from_rad = static_cast<double>(*std::prev(above));
  const double share = (behind_first_rad - from_rad) / (static_cast<double>(*above) - from_rad);
  return between(table, static_cast<std::size_t>(above - knots.begin() - 1), std::min(share, 1.0));
}

/// Clenshaw's recursion.
Vector3d lookup_chebyshev(const FieldTable& table, double behind_first_rad) {
  const double x = behind_first_rad / std::numbers::pi - 1.0;
  Vector3d above = Vector3d::Zero();
  Vector3d here = Vector3d::Zero();
  for (std::size_t k = table.rows.size() - 1; k > 0; --k) {
    const Vector3d next = table.rows[k].cast<double>() + 2.0 * x * here - above;
    above = here;
    here = next;
  }
  return table.rows.front().cast<double>() + x * here - above;
}

}  // namespace

std::string_view name_of(TableKind kind) {
  constexpr std::array<std::string_view, kTableKinds.size()> kNames{"uniform", "curvature",
                                                                    "chebyshev"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::optional<TableKind> table_kind(std::string_view name) {
  const auto* const kind = std::find_if(kTableKinds.begin(), kTableKinds.end(),
                                        [&](TableKind is) { return name_of(is) == name; });
  return kind == kTableKinds.end() ? std::nullopt : std::optional{*kind};
}

Expected<FieldTable> make_table(const FieldAlong& field, TableKind kind, double first_anomaly_rad,
                                int points) {
  if (points < kFewestTablePoints || points > kMostTablePoints) {
    return Unexpected{
        {ErrorCode::InvalidInput, fmt::format("a table of {} points: must be {} to {}", points,
                                              kFewestTablePoints, kMostTablePoints)}};
  }
  switch (kind) {
    case TableKind::Uniform:
      return uniform_table(field, first_anomaly_rad, points);
    case TableKind::Curvature:
      return curvature_table(field, first_anomaly_rad, points);
    case TableKind::Chebyshev:
      break;
  }
  return chebyshev_table(field, first_anomaly_rad, points);
}

Vector3d lookup(const FieldTable& table, double behind_first_rad) {
  const double within_rad = std::clamp(behind_first_rad, 0.0, kTurn_rad);
  switch (table.kind) {
    case TableKind::Uniform:
      return lookup_uniform(table, within_rad);
    case TableKind::Curvature:
      return lookup_curvature(table, within_rad);
    case TableKind::Chebyshev:
      break;
  }
  return lookup_chebyshev(table, within_rad);
}

Expected<SampledField> sampled(const FieldAlong& field, int samples) {
  SampledField sampled_nt{3, samples};
  for (Eigen::Index i = 0; i < samples; ++i) {
    const auto field_nt = field(anomaly_of(i, samples));
    if (!field_nt) {
      return Unexpected{field_nt.error()};
    }
    sampled_nt.col(i) = *field_nt;
  }
  return sampled_nt;
}

TableErrors errors_of(const FieldTable& table, const SampledField& truth_nt) {
  TableErrors errors{.mean_nt = Vector3d::Zero(), .most_nt = Vector3d::Zero()};
  for (Eigen::Index i = 0; i < truth_nt.cols(); ++i) {
    const Vector3d off_nt =
        (lookup(table, anomaly_of(i, truth_nt.cols())) - truth_nt.col(i)).cwiseAbs();
    errors.mean_nt += off_nt;
    errors.most_nt = errors.most_nt.cwiseMax(off_nt);
  }
  errors.mean_nt /= static_cast<double>(truth_nt.cols());
  return errors;
}

}  // namespace spindrift
