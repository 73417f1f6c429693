/// Cost of the main field to degree 13, compared with using GeographicLib directly.

#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "pipelines/geomagnetism/tables/field_table.h"
#include "pipelines/geomagnetism/tables/revolution_field.h"
#include "services/mission/igrf.h"
#include "tests/support/geographiclib_field.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

constexpr double kYear = 2026.9;

std::vector<Vector3d> positions_km() {
  std::mt19937_64 rng{1701};
  std::normal_distribution<double> normal;
  std::vector<Vector3d> positions;
  for (int i = 0; i < 1000; ++i) {
    positions.emplace_back(7000.0 * Vector3d{normal(rng), normal(rng), normal(rng)}.normalized());
  }
  return positions;
}

template <class FieldAt>
void measure(benchmark::State& state, const FieldAt& field_at) {
  const std::vector<Vector3d> positions = positions_km();
  for ([[maybe_unused]] const auto iteration : state) {
    Vector3d sum_nt = Vector3d::Zero();
    for (const Vector3d& position_km : positions) {
      sum_nt += field_at(position_km);
    }
    benchmark::DoNotOptimize(sum_nt);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(positions.size()));
}

void BM_MainField(benchmark::State& state) {
  const MainField field = igrf()->at(kYear).value();
  measure(state, [&](const Vector3d& position_km) { return field.at(position_km).value(); });
}
BENCHMARK(BM_MainField);

void BM_GeographicLib(benchmark::State& state) {
  const testing::GeographicLibField field{igrf()->coefficients(kYear).value(), kHighestDegree};
  measure(state, [&](const Vector3d& position_km) { return field.at(position_km); });
}
BENCHMARK(BM_GeographicLib);

void BM_MainFieldOfAnotherDateEach(benchmark::State& state) {
  const MainFieldModel model = igrf().value();
  double year = 2025.0;
  measure(state, [&](const Vector3d& position_km) {
    year += year < 2029.0 ? 1e-9 : -4.0;
    return model.at(year)->at(position_km).value();
  });
}
BENCHMARK(BM_MainFieldOfAnotherDateEach);

/// A table of the field along the orbit of a femtosatellite, its knots chosen if need be.
void BM_FieldTable(benchmark::State& state) {
  const auto kind = static_cast<TableKind>(state.range(0));
  const KeplerOrbit orbit = KeplerOrbit::make({.epoch = instant_of_year(kYear),
                                               .semi_major_axis_km = 7021.2,
                                               .eccentricity = 0.0,
                                               .inclination_rad = 1.7,
                                               .raan_rad = 0.2,
                                               .argument_of_perigee_rad = 0.0,
                                               .mean_anomaly_rad = 0.0})
                                .value();
  const MainField field = igrf()->at(kYear).value();
  for ([[maybe_unused]] const auto iteration : state) {
    RevolutionField revolution{orbit, field};
    benchmark::DoNotOptimize(
        make_table([&](double behind_rad) { return revolution.at(behind_rad); }, kind, 0.0,
                   static_cast<int>(state.range(1))));
  }
}
BENCHMARK(BM_FieldTable)
    ->ArgsProduct({{0, 1, 2}, {80, kMostTablePoints}})
    ->ArgNames({"kind", "points"})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace spindrift
