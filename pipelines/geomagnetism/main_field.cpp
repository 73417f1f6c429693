#include "pipelines/geomagnetism/main_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>

namespace spindrift {
namespace {

using Eigen::Vector3d;
using std::chrono::days;

constexpr std::size_t kRow = kHighestDegree + 2;

/// Factors of the recursion V_nm = by_z z V_n-1,m - by_square V_n-2,m.
struct Steps {
  std::array<std::array<double, kRow>, kRow> by_z{};
  std::array<std::array<double, kRow>, kRow> by_square{};
};

constexpr Steps kSteps = [] {
  Steps steps;
  for (std::size_t n = 1; n < kRow; ++n) {
    for (std::size_t m = 0; m < n; ++m) {
      const auto rest = static_cast<double>(n - m);
      steps.by_z[n][m] = static_cast<double>(2 * n - 1) / rest;
      steps.by_square[n][m] = static_cast<double>(n + m - 1) / rest;
    }
  }
  return steps;
}();

/// Harmonics V_nm + i W_nm of one degree n: the solid harmonics (a/r)^(n+1) P_nm(sin b) e^(i m l),
/// with P_nm unnormalised; 0 where m is n + 1, not set beyond.
struct Harmonics {
  std::array<double, kRow + 1> v;
  std::array<double, kRow + 1> w;
};

/// Computes degree n from the two below. @param scaled (a/r^2) times the position. @param square
/// (a/r)^2.
void find_degree(std::size_t n, const Vector3d& scaled, double square,
                 const Harmonics& second_below, const Harmonics& below, Harmonics& here) {
  for (std::size_t m = 0; m < n; ++m) {
    const double by_z = kSteps.by_z[n][m] * scaled.z();
    const double by_square = kSteps.by_square[n][m] * square;
    here.v[m] = by_z * below.v[m] - by_square * second_below.v[m];
    here.w[m] = by_z * below.w[m] - by_square * second_below.w[m];
  }
  const auto odd = static_cast<double>(2 * n - 1);
  here.v[n] = odd * (scaled.x() * below.v[n - 1] - scaled.y() * below.w[n - 1]);
  here.w[n] = odd * (scaled.x() * below.w[n - 1] + scaled.y() * below.v[n - 1]);
  here.v[n + 1] = 0.0;
  here.w[n + 1] = 0.0;
}

/// Adds the part of the coefficients of degree n, from the harmonics of degree n + 1.
void add_degree(std::size_t n, const Harmonics& above, const GaussCoefficients& coefficients,
                Vector3d& field_nt) {
  const double* const g = &coefficients.g_nt[n * (n + 1) / 2];
  const double* const h = &coefficients.h_nt[n * (n + 1) / 2];
  const auto& [v, w] = above;
  double x = 2.0 * g[0] * v[1];
  double y = 2.0 * g[0] * w[1];
  double z = static_cast<double>(n + 1) * g[0] * v[0];
  for (std::size_t m = 1; m <= n; ++m) {
    const auto rest = static_cast<double>(n - m + 1);
    const double down = rest * (rest + 1.0);
    x += g[m] * (v[m + 1] - down * v[m - 1]) + h[m] * (w[m + 1] - down * w[m - 1]);
    y += g[m] * (w[m + 1] + down * w[m - 1]) - h[m] * (v[m + 1] + down * v[m - 1]);
    z += rest * (g[m] * v[m] + h[m] * w[m]);
  }
  field_nt += Vector3d{0.5 * x, 0.5 * y, z};
}

/// Returns Schmidt's factors, sqrt(2 (n - m)! / (n + m)!) and 1 for m = 0.
const std::array<double, GaussCoefficients::kCount>& normalisations() {
  static const auto kFactors = [] {
    std::array<double, GaussCoefficients::kCount> factors{};
    for (int n = 0; n <= kHighestDegree; ++n) {
      double square = 2.0;
      factors.at(GaussCoefficients::index(n, 0)) = 1.0;
      for (int m = 1; m <= n; ++m) {
        square /= (n - m + 1) * (n + m);
        factors.at(GaussCoefficients::index(n, m)) = std::sqrt(square);
      }
    }
    return factors;
  }();
  return kFactors;
}

struct YearSpan {
  days beginning;  ///< Start of the year, days since 1970.
  days length;
};

YearSpan span_of(std::chrono::year year) {
  using namespace std::chrono;
  const auto beginning = sys_days{year / January / 1}.time_since_epoch();
  return {.beginning = beginning,
          .length = sys_days{(year + years{1}) / January / 1}.time_since_epoch() - beginning};
}

}  // namespace

MainField::MainField(const GaussCoefficients& coefficients, int degree) : degree_{degree} {
  const auto& factors = normalisations();
  for (std::size_t i = 0; i < GaussCoefficients::kCount; ++i) {
    unnormalised_.g_nt[i] = factors[i] * coefficients.g_nt[i];
    unnormalised_.h_nt[i] = factors[i] * coefficients.h_nt[i];
  }
}

Expected<Vector3d> MainField::at(const Vector3d& position_itrf_km) const {
  const double distance_km = position_itrf_km.norm();
  if (!(distance_km >= kCoreRadius_km && std::isfinite(distance_km))) {
    return Unexpected{{ErrorCode::InvalidInput,
                       fmt::format("{:.6g} km from the Earth's centre: the field is known from {} "
                                   "km outwards, where its sources end",
                                   distance_km, kCoreRadius_km)}};
  }
  const double scale = kFieldRadius_km / (distance_km * distance_km);
  const Vector3d scaled = scale * position_itrf_km;
  std::array<Harmonics, kRow + 1> of;  // Starts at degree -1, which is 0.
  of[0].v[0] = of[0].w[0] = 0.0;
  of[1].v = {kFieldRadius_km / distance_km, 0.0};
  of[1].w = {0.0, 0.0};
  Vector3d field_nt = Vector3d::Zero();
  for (std::size_t n = 1; n <= static_cast<std::size_t>(degree_) + 1; ++n) {
    find_degree(n, scaled, scale * kFieldRadius_km, of[n - 1], of[n], of[n + 1]);
    add_degree(n - 1, of[n + 1], unnormalised_, field_nt);
  }
  return field_nt;
}

Expected<Vector3d> MainField::ned_at(const LocalFrame& frame) const {
  return at(frame.origin_itrf_km).map([&](const Vector3d& field_nt) -> Vector3d {
    return frame.q_itrf_ned.conjugate() * field_nt;
  });
}

double decimal_year(TaiTime t) {
  using namespace std::chrono;
  const auto since_1970 = t.time_since_epoch();
  const year in = year_month_day{sys_days{floor<days>(since_1970)}}.year();
  const YearSpan span = span_of(in);
  return static_cast<int>(in) + duration<double>{since_1970 - span.beginning} / span.length;
}

TaiTime instant_of_year(double year) {
  const double whole = std::floor(year);
  const YearSpan span = span_of(std::chrono::year{static_cast<int>(whole)});
  return shifted(TaiTime{span.beginning},
                 (year - whole) * std::chrono::duration<double>{span.length}.count());
}

Expected<MainFieldModel> MainFieldModel::make(std::vector<FieldEpoch> epochs) {
  if (epochs.size() < 2) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("a main field of {} epochs: at least 2", epochs.size())}};
  }
  for (std::size_t i = 1; i < epochs.size(); ++i) {
    if (!(epochs[i - 1].year < epochs[i].year)) {
      return Unexpected{{ErrorCode::InvalidConfiguration,
                         fmt::format("a main field with epoch {} behind {}: must be later",
                                     epochs[i].year, epochs[i - 1].year)}};
    }
  }
  return MainFieldModel{std::move(epochs)};
}

Expected<GaussCoefficients> MainFieldModel::coefficients(double year) const {
  if (!(year >= first_year() && year <= last_year())) {
    return Unexpected{
        {ErrorCode::NoCoverage, fmt::format("the geomagnetic field of year {}: known from {} to {}",
                                            year, first_year(), last_year())}};
  }
  const auto later =
      std::upper_bound(epochs_.begin() + 1, epochs_.end() - 1, year,
                       [](double at, const FieldEpoch& epoch) { return at < epoch.year; });
  const GaussCoefficients& from = std::prev(later)->coefficients;
  const GaussCoefficients& to = later->coefficients;
  const double share = (year - std::prev(later)->year) / (later->year - std::prev(later)->year);
  GaussCoefficients between;
  for (std::size_t i = 0; i < GaussCoefficients::kCount; ++i) {
    between.g_nt[i] = from.g_nt[i] + share * (to.g_nt[i] - from.g_nt[i]);
    between.h_nt[i] = from.h_nt[i] + share * (to.h_nt[i] - from.h_nt[i]);
  }
  return between;
}

Expected<MainField> MainFieldModel::at(double year, int degree) const {
  if (degree < 1 || degree > kHighestDegree) {
    return Unexpected{
        {ErrorCode::InvalidInput, fmt::format("the geomagnetic field to degree {}: must be 1 to {}",
                                              degree, kHighestDegree)}};
  }
  return coefficients(year).map([&](const GaussCoefficients& of_year) {
    return MainField{of_year, degree};
  });
}

Expected<Eigen::Vector3d> field_icrf_nt(const MainFieldModel& model, TaiTime t,
                                        const Eigen::Vector3d& position_icrf_km,
                                        TurningEarth& earth) {
  const Eigen::Quaterniond q_icrf_itrf = earth.orientation(t);
  return model.at(decimal_year(t))
      .and_then([&](const MainField& field) {
        return field.at(q_icrf_itrf.conjugate() * position_icrf_km);
      })
      .map([&](const Eigen::Vector3d& field_itrf_nt) -> Eigen::Vector3d {
        return q_icrf_itrf * field_itrf_nt;
      });
}

}  // namespace spindrift
