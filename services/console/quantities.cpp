#include "services/console/quantities.h"

#include <fmt/format.h>

#include <initializer_list>
#include <string_view>

#include "pipelines/spin/types/products.h"

namespace spindrift {
namespace {

/// @param value Expression over the columns of `table`.
Quantity quantity(std::string_view name, std::string_view unit, std::string_view table,
                  std::string_view value, std::string_view condition) {
  return {.name = std::string{name},
          .unit = std::string{unit},
          .sql = fmt::format("SELECT t_tai_ns, {}, NULL, NULL FROM {} WHERE run_id = ?1 AND {} AND "
                             "t_tai_ns <= ?2 ORDER BY t_tai_ns DESC",
                             value, table, condition)};
}

/// Makes the series of a measurement. Sorting by revolution gives the order of time.
Quantity measurement(SpinQuantity of) {
  return {.name = std::string{name_of(of)},
          .unit = of == SpinQuantity::Period ? "s" : "deg",
          .sql = fmt::format(
              "SELECT t_tai_ns, value, accepted, rejected_by, value - expected, \"limit\", unit "
              "FROM revolution CROSS JOIN spin_measurement USING (run_id, revolution) WHERE "
              "run_id = ?1 AND quantity = '{}' AND t_tai_ns <= ?2 ORDER BY revolution DESC",
              name_of(of))};
}

/// Makes the series of a channel's spin phase. An edge outside any revolution has its phase from
/// the turn of the edge before it. The limit is that of the failed test, or of the filter.
Quantity phase(std::string_view channel) {
  return {
      .name = fmt::format("phase_{}", channel),
      .unit = "deg",
      .sql = fmt::format(
          "SELECT t_tai_ns, 360 * (turns - floor(turns)), accepted, rejected_by, off, \"limit\", "
          "unit, used FROM (SELECT edge.t_tai_ns, (edge.t_tai_ns - turn.t_tai_ns) / (1e9 * "
          "period_s) AS turns, edge.accepted, edge.rejected_by, edge.used, coalesce(value - "
          "expected, gap_s, residual_ns * 1.0 / sigma_ns) AS off, coalesce(\"limit\", least_gap_s, "
          "residual_limit_milli / 1e3) AS \"limit\", coalesce(unit, iif(gap_s IS NULL, 'sigma', "
          "'s')) AS unit FROM pulse_use AS edge CROSS JOIN revolution AS turn "
          "ON turn.run_id = edge.run_id AND turn.revolution = coalesce(edge.revolution, (SELECT "
          "revolution FROM pulse_use AS before WHERE before.run_id = edge.run_id AND "
          "before.t_tai_ns < edge.t_tai_ns AND before.revolution IS NOT NULL ORDER BY "
          "before.t_tai_ns DESC LIMIT 1)) LEFT JOIN pulse_gap AS gap ON gap.run_id = edge.run_id "
          "AND gap.t_tai_ns = edge.t_tai_ns AND gap.channel = edge.channel LEFT JOIN "
          "spin_measurement AS test ON test.run_id = edge.run_id AND test.revolution = "
          "edge.revolution AND test.quantity = edge.rejected_by WHERE edge.run_id = ?1 AND "
          "edge.channel = '{}' AND edge.t_tai_ns <= ?2) ORDER BY t_tai_ns DESC",
          channel)};
}

/// Makes the series of a channel's residuals in `sequential`.
Quantity edge_residual(std::string_view channel) {
  return {.name = fmt::format("residual_{}", channel),
          .unit = "sigma",
          .sql = fmt::format(
              "SELECT t_tai_ns, residual_ns * 1.0 / sigma_ns, used, CASE used WHEN 0 THEN "
              "coalesce(rejected_by, 'innovation') END, residual_ns * 1.0 / sigma_ns, "
              "residual_limit_milli / 1e3, 'sigma' FROM pulse_use WHERE run_id = ?1 AND channel = "
              "'{}' AND residual_ns IS NOT NULL AND "
              "t_tai_ns <= ?2 ORDER BY t_tai_ns DESC",
              channel)};
}

/// Transforms a chi-square into a normal deviate (Wilson and Hilferty 1931), which stays within 3
/// for a consistent filter, whatever its degrees of freedom.
std::string deviate(std::string_view square, std::string_view freedom) {
  return fmt::format("(pow({0} / {1}, 1.0 / 3) - 1 + 2.0 / (9 * {1})) * sqrt(9 * {1} / 2.0)",
                     square, freedom);
}

/// Makes the series of the residuals of a kind of sample in the filter.
Quantity sample_residual(std::string_view kind) {
  return {.name = fmt::format("residual_{}", kind),
          .unit = "sigma",
          .sql = fmt::format(
              "SELECT t_tai_ns, {}, used, rejected_by, nis, \"limit\", 'chi-square' FROM "
              "sample_residual WHERE run_id = ?1 AND kind = '{}' AND dof > 0 AND estimator NOT IN "
              "('batch', 'sequential') AND t_tai_ns <= ?2 ORDER BY t_tai_ns DESC",
              deviate("nis", "dof"), kind)};
}

Quantity innovation() {
  return {
      .name = "innovation",
      .unit = "sigma",
      .sql = fmt::format(
          "SELECT t_tai_ns, {}, 1, NULL FROM attitude WHERE run_id = ?1 AND innovation_freedom "
          "> 0 AND t_tai_ns <= ?2 UNION ALL SELECT t_tai_ns, {}, 0, rejected_by || ', ' || kind "
          "FROM rejected_sample WHERE run_id = ?1 AND squared_innovation IS NOT NULL AND "
          "t_tai_ns <= ?2 ORDER BY t_tai_ns DESC",
          deviate("squared_innovations", "innovation_freedom"),
          deviate("squared_innovation", "CASE kind WHEN 'sun' THEN 2 ELSE 3 END"))};
}

Quantity fix(std::string_view column) {
  return {.name = fmt::format("fix_{}", column),
          .unit = "deg",
          .sql = fmt::format("SELECT t_tai_ns, {}, accepted, NULL FROM spin_fix WHERE run_id = ?1 "
                             "AND t_tai_ns <= ?2 ORDER BY revolution DESC",
                             column)};
}

std::vector<Quantity> of_spin() {
  std::vector<Quantity> all;
  for (const SpinQuantity one :
       {SpinQuantity::SunAngle, SpinQuantity::Period, SpinQuantity::NorthChord,
        SpinQuantity::SouthChord, SpinQuantity::NorthDihedral, SpinQuantity::SouthDihedral,
        SpinQuantity::MixedAzimuth}) {
    all.push_back(measurement(one));
  }
  for (const std::string_view channel : kPulseChannelNames) {
    all.push_back(phase(channel));
  }
  for (const SpinEstimator estimator :
       {SpinEstimator::Mean, SpinEstimator::Sequential, SpinEstimator::Batch}) {
    for (const std::string_view column :
         {"sigma_deg", "ra_deg", "dec_deg", "spin_rate_rpm", "sigma_rpm"}) {
      all.push_back(quantity(fmt::format("{}_{}", name_of(estimator), column),
                             column.ends_with("rpm") ? "rpm" : "deg", "spin_estimate", column,
                             fmt::format("estimator = '{}'", name_of(estimator))));
    }
  }
  for (const std::string_view channel : kPulseChannelNames) {
    all.push_back(edge_residual(channel));
  }
  all.push_back(quantity("bound_deg", "deg", "spin_batch", "bound_deg", "TRUE"));
  for (const std::string_view column : {"sigma_deg", "ra_deg", "dec_deg"}) {
    all.push_back(fix(column));
  }
  return all;
}

std::vector<Quantity> of_three_axis() {
  constexpr std::string_view kFiltered = "source NOT IN ('batch', 'sequential')";
  std::vector<Quantity> all{quantity("sigma_deg", "deg", "attitude", "sigma_deg", kFiltered)};
  for (const std::string_view axis : {"x", "y", "z"}) {
    all.push_back(quantity(
        fmt::format("rate_{}_deg_s", axis), "deg/s", "attitude",
        fmt::format("degrees(rate_{}_rad_s)", axis),
        fmt::format("source NOT IN ('batch', 'sequential') AND rate_{}_rad_s IS NOT NULL", axis)));
  }
  for (const std::string_view column : {"qx", "qy", "qz", "qw"}) {
    all.push_back(quantity(column, "1", "attitude", column, kFiltered));
  }
  all.push_back(innovation());
  for (const std::string_view kind : {"star", "sun", "magnetometer"}) {
    all.push_back(sample_residual(kind));
  }
  return all;
}

}  // namespace

const std::vector<Quantity>& quantities_of(SpacecraftKind kind) {
  static const std::vector<Quantity> kOfSpin = of_spin();
  static const std::vector<Quantity> kOfThreeAxis = of_three_axis();
  return kind == SpacecraftKind::Spin ? kOfSpin : kOfThreeAxis;
}

}  // namespace spindrift
