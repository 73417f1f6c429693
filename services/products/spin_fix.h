/// @file
/// The spin axis from one revolution alone, as a kind of product.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "pipelines/spin/types/products.h"
#include "services/products/axis_columns.h"
#include "services/products/named.h"
#include "services/products/product_kind.h"

namespace spindrift {

struct SpinFixTable {
  static constexpr std::string_view kName = "spin_fix";
  static constexpr std::array<std::string_view, 1> kKey{"revolution"};

  static std::optional<PlaceDeg> alternate(const SpinFix& fix) {
    return fix.alternates.empty() ? std::nullopt
                                  : std::optional{place_deg(fix.alternates.front().axis_icrf)};
  }
  using Axis = AxisColumns<SpinFix>;
  static constexpr auto kColumns = columns(
      ProductColumn{"revolution", &SpinFix::revolution},
      ProductColumn{"t_tai_ns", [](const SpinFix& fix) { return tai_ns(fix.t); }},
      ProductColumn{"geometry_case",
                    [](const SpinFix& fix) { return std::int64_t{fix.geometry_case}; }},
      ProductColumn{"ra_deg", &Axis::ra_deg}, ProductColumn{"dec_deg", &Axis::dec_deg},
      ProductColumn{"sigma_deg", &Axis::sigma_deg},
      ProductColumn{"noise_sigma_deg", &Axis::noise_sigma_deg},
      ProductColumn{"cov_east_east_deg2", &Axis::covariance_deg2<0, 0>},
      ProductColumn{"cov_east_north_deg2", &Axis::covariance_deg2<0, 1>},
      ProductColumn{"cov_north_north_deg2", &Axis::covariance_deg2<1, 1>},
      ProductColumn{"alternate_ra_deg",
                    [](const SpinFix& fix) -> std::optional<double> {
                      const auto place = alternate(fix);
                      return place ? std::optional{place->ra_deg} : std::nullopt;
                    }},
      ProductColumn{"alternate_dec_deg",
                    [](const SpinFix& fix) -> std::optional<double> {
                      const auto place = alternate(fix);
                      return place ? std::optional{place->dec_deg} : std::nullopt;
                    }},
      ProductColumn{"resolution", [](const SpinFix& fix) { return name_of(said_resolution(fix)); }},
      ProductColumn{"norm", &SpinFix::norm}, ProductColumn{"accepted", &SpinFix::accepted},
      ProductColumn{"misfit", &SpinFix::misfit},
      ProductColumn{"alternate_misfit", [](const SpinFix& fix) {
                      return fix.alternates.empty() ? std::nullopt
                                                    : std::optional{fix.alternates.front().misfit};
                    }});
};

/// The other candidate axes of a fix, besides the first alternate (view spin_fix_candidate).
struct SpinFixOtherTable {
  static constexpr std::string_view kName = "spin_fix_other";
  static constexpr std::array<std::string_view, 2> kKey{"revolution", "candidate"};

  struct Row {
    std::int64_t revolution;
    std::int64_t candidate;
    PlaceDeg place;
    double misfit;
  };
  static constexpr auto kColumns = columns(
      ProductColumn{"revolution", &Row::revolution}, ProductColumn{"candidate", &Row::candidate},
      ProductColumn{"ra_deg", [](const Row& row) { return row.place.ra_deg; }},
      ProductColumn{"dec_deg", [](const Row& row) { return row.place.dec_deg; }},
      ProductColumn{"misfit", &Row::misfit});

  static std::int64_t group(const SpinFix& fix) { return fix.revolution; }
  static std::vector<Row> rows(const SpinFix& fix) {
    std::vector<Row> rows;
    for (std::size_t i = 1; i < fix.alternates.size(); ++i) {
      rows.push_back({.revolution = fix.revolution,
                      .candidate = static_cast<std::int64_t>(i) + 1,
                      .place = place_deg(fix.alternates[i].axis_icrf),
                      .misfit = fix.alternates[i].misfit});
    }
    return rows;
  }
};

template <>
struct ProductKind<SpinFix> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<SpinFixTable, SpinFixOtherTable>;

  static constexpr const char* kTopic = "spindrift/spin_fix";
  /// A fix from contradictory measurements would look like a good one on the bus.
  static bool is_announced(const SpinFix& fix) {
    return fix.accepted || fix.resolution == Resolution::Ambiguous;
  }
  static constexpr std::string_view instance(const SpinFix& /*fix*/) { return {}; }
  static std::int64_t number(const SpinFix& fix) { return fix.revolution; }
  /// An AMBIGUOUS fix may be given again once it is decided.
  static bool is_settled(const SpinFix& fix) { return fix.accepted; }

  /// Restores a fix with its best alternate only, without the misfits.
  template <class Row>
  static SpinFix from_row(const Row& row) {
    SpinFix fix{.revolution = row.integer("revolution"),
                .t = tai_from_ns(row.integer("t_tai_ns")),
                .geometry_case = static_cast<int>(row.integer("geometry_case")),
                .axis_icrf = axis_icrf_from(row.real("ra_deg"), row.real("dec_deg")),
                .covariance_rad2 = covariance_rad2_of(row),
                .alternates = {},
                .resolution = named(row.text("resolution"), Resolution::Ambiguous),
                .norm = row.real("norm"),
                .accepted = row.integer("accepted") != 0,
                .alignment_rad2 = alignment_rad2_of(row)};
    if (row.has("alternate_ra_deg")) {
      fix.alternates = {{.axis_icrf = axis_icrf_from(row.real("alternate_ra_deg"),
                                                     row.real("alternate_dec_deg"))}};
    }
    return fix;
  }
};

/// The axis that a pass has selected.
struct AxisChoiceTable {
  static constexpr std::string_view kName = "axis_choice";
  static constexpr std::array<std::string_view, 1> kKey{"run_id"};
  /// Only `batch` compares the fit of the other axis.
  static constexpr std::string_view kReplaces =
      "excluded.estimator = 'batch' OR axis_choice.estimator <> 'batch'";

  static std::optional<PlaceDeg> other(const AxisChoice& choice) {
    return choice.other_icrf ? std::optional{place_deg(*choice.other_icrf)} : std::nullopt;
  }
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", [](const AxisChoice& one) { return tai_ns(one.t); }},
      ProductColumn{"estimator", [](const AxisChoice& one) { return name_of(one.estimator); }},
      ProductColumn{"ra_deg",
                    [](const AxisChoice& one) { return place_deg(one.axis_icrf).ra_deg; }},
      ProductColumn{"dec_deg",
                    [](const AxisChoice& one) { return place_deg(one.axis_icrf).dec_deg; }},
      ProductColumn{"other_ra_deg",
                    [](const AxisChoice& one) {
                      const auto place = other(one);
                      return place ? std::optional{place->ra_deg} : std::nullopt;
                    }},
      ProductColumn{"other_dec_deg",
                    [](const AxisChoice& one) {
                      const auto place = other(one);
                      return place ? std::optional{place->dec_deg} : std::nullopt;
                    }},
      ProductColumn{"delta_chi_square", &AxisChoice::delta_chi_square},
      ProductColumn{"settled_by", [](const AxisChoice& one) { return name_of(one.settled_by); }});
};

/// How errors of the mission file move the axis of each estimator.
struct AxisShiftTable {
  static constexpr std::string_view kName = "axis_shift";
  static constexpr std::array<std::string_view, 3> kKey{"of_batch", "estimator", "position"};

  struct Row {
    std::int64_t of_batch;
    SpinEstimator estimator;
    std::int64_t position;
    TaiTime t;
    Eigen::Vector3d shift_icrf;
  };
  static std::int64_t group(const AxisChoice& choice) {
    return choice.estimator == SpinEstimator::Batch ? 1 : 0;
  }
  /// Gives no row where the mission file counts as exact.
  static std::vector<Row> rows(const AxisChoice& choice) {
    std::vector<Row> rows;
    for (const EstimatorShift& of : choice.shifts) {
      for (Eigen::Index i = 0; i < kSpinAlignmentErrors && !of.shift_icrf.isZero(0.0); ++i) {
        rows.push_back({.of_batch = group(choice),
                        .estimator = of.estimator,
                        .position = i + 1,
                        .t = choice.t,
                        .shift_icrf = of.shift_icrf.col(i)});
      }
    }
    return rows;
  }
  template <int kAxis>
  static double shift_deg(const Row& row) {
    return row.shift_icrf[kAxis] * kDegPerRad;
  }
  static constexpr auto kColumns =
      columns(ProductColumn{"of_batch", &Row::of_batch},
              ProductColumn{"estimator", [](const Row& row) { return name_of(row.estimator); }},
              ProductColumn{"position", &Row::position},
              ProductColumn{"t_tai_ns", [](const Row& row) { return tai_ns(row.t); }},
              ProductColumn{"x_deg", &shift_deg<0>}, ProductColumn{"y_deg", &shift_deg<1>},
              ProductColumn{"z_deg", &shift_deg<2>});
};

template <>
struct ProductKind<AxisChoice> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<AxisChoiceTable, AxisShiftTable>;
};

}  // namespace spindrift
