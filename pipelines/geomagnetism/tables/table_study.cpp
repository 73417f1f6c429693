#include "pipelines/geomagnetism/tables/table_study.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "pipelines/ephemeris/flight_frames.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/geomagnetism/tables/curvature_knots.h"
#include "pipelines/geomagnetism/tables/on_board_attitude.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

constexpr int kRuns = 50;
constexpr int kPlaces = 589;  // Ten seconds apart in a low orbit.
constexpr std::uint64_t kSeed = 2;

Vector3d angles_of(const Eigen::Quaterniond& q) {
  const Euler312 angles = euler312_of(q).angles;
  return {angles.phi_rad, angles.theta_rad, angles.psi_rad};
}

Expected<std::vector<StudyPlace>> places_of(const KeplerOrbit& orbit, const FieldAlong& field) {
  ApparentSun sun;
  std::vector<StudyPlace> places;
  for (int i = 0; i < kPlaces; ++i) {
    const double behind_rad = kTurn_rad * i / (kPlaces - 1);
    const TaiTime t = orbit.when_behind_epoch(behind_rad);
    auto place = orbit.at(t).and_then([&](const OrbitState& spacecraft) {
      return orbit_frame(spacecraft).and_then([&](const Eigen::Quaterniond& q_icrf_orbit) {
        return field(behind_rad).map([&](const Vector3d& field_nt) {
          return StudyPlace{
              .behind_first_rad = behind_rad,
              .field_orbit_nt = field_nt,
              .sun_orbit = q_icrf_orbit.conjugate() * sun.direction_icrf(t, spacecraft)};
        });
      });
    });
    if (!place) {
      return Unexpected{place.error()};
    }
    places.push_back(*place);
  }
  return places;
}

/// Adds up the squares of what tables move the attitude by, and notes the first run.
class AttitudeStudy {
 public:
  AttitudeStudy(const std::vector<FieldTable>& tables, const FieldTable& chosen)
      : tables_{tables}, chosen_{chosen}, sum_rad_(tables.size(), Vector3d::Zero()) {}

  void add(const StudyPlace& place) {
    std::vector<Vector3d> squares(tables_.size(), Vector3d::Zero());
    for (int run = 0; run < kRuns; ++run) {
      if (!add_run(place, run, squares)) {
        ++in_line_;
        return;
      }
    }
    for (std::size_t i = 0; i < tables_.size(); ++i) {
      sum_rad_[i] += (squares[i] / kRuns).cwiseSqrt();
    }
    ++places_;
  }

  Vector3d armse_rad(std::size_t table) const { return sum_rad_[table] / std::max(places_, 1); }
  const std::vector<StudiedAttitude>& attitudes() const { return attitudes_; }
  const MostOff& most() const { return most_; }
  int in_line() const { return in_line_; }

 private:
  SunAndField measure(const StudyPlace& place) {
    const auto noise = [this] { return Vector3d{normal_(rng_), normal_(rng_), normal_(rng_)}; };
    return {.sun = place.sun_orbit + kStudySunNoise * noise(),
            .field_nt = place.field_orbit_nt + kStudyFieldNoise_nt * noise()};
  }

  /// @return False where Sun and field are in line.
  bool add_run(const StudyPlace& place, int run, std::vector<Vector3d>& squares) {
    const SunAndField measured = measure(place);
    const auto with = [&](const Vector3d& field_orbit_nt) {
      return two_vector_attitude(measured, {.sun = place.sun_orbit, .field_nt = field_orbit_nt});
    };
    const auto with_table = [&](const FieldTable& table) {
      return with(lookup(table, place.behind_first_rad));
    };
    const auto with_field = with(place.field_orbit_nt);
    const auto with_chosen = with_table(chosen_);
    if (!with_field || !with_chosen) {
      return false;
    }
    for (std::size_t i = 0; i < tables_.size(); ++i) {
      const auto attitude = with_table(tables_[i]);
      if (!attitude) {
        return false;
      }
      squares[i] += angles_of(with_field->conjugate() * *attitude).cwiseAbs2();
    }
    note({.behind_first_rad = place.behind_first_rad,
          .with_field_rad = angles_of(*with_field),
          .with_table_rad = angles_of(*with_chosen)},
         run);
    return true;
  }

  void note(const StudiedAttitude& at, int run) {
    if (run == 0) {
      attitudes_.push_back(at);
    }
    most_.with_field_rad = most_.with_field_rad.cwiseMax(at.with_field_rad.cwiseAbs());
    most_.with_table_rad = most_.with_table_rad.cwiseMax(at.with_table_rad.cwiseAbs());
    most_.by_table_rad =
        most_.by_table_rad.cwiseMax((at.with_table_rad - at.with_field_rad).cwiseAbs());
  }

  const std::vector<FieldTable>& tables_;
  const FieldTable& chosen_;
  std::mt19937_64 rng_{kSeed};
  std::normal_distribution<double> normal_;
  std::vector<Vector3d> sum_rad_;
  std::vector<StudiedAttitude> attitudes_;
  MostOff most_;
  int places_ = 0;
  int in_line_ = 0;
};

std::vector<StudiedWeight> weights_of(const SampledField& field_nt) {
  const std::vector<double> curvature = chord_curvature(field_nt);
  std::vector<StudiedWeight> weights;
  for (const double weight : studied_weights()) {
    weights.push_back({.weight = weight,
                       .mean_error_nt = mean_error_nt(
                           field_nt, knots_by_curvature(curvature, weight, kChosenPoints))});
  }
  return weights;
}

/// Makes a table of each kind and size.
Expected<std::vector<FieldTable>> tables_of(const FieldAlong& field, double first_anomaly_rad) {
  std::vector<FieldTable> tables;
  for (const TableKind kind : kTableKinds) {
    for (const int points : kStudiedPoints) {
      auto table = make_table(field, kind, first_anomaly_rad, points);
      if (!table) {
        return Unexpected{table.error()};
      }
      tables.push_back(std::move(*table));
    }
  }
  return tables;
}

/// Returns the table of a kind that has the paper's number of points.
const FieldTable& chosen_of(const std::vector<FieldTable>& tables, TableKind kind) {
  return *std::find_if(tables.begin(), tables.end(), [&](const FieldTable& is) {
    return is.kind == kind && is.rows.size() == kChosenPoints;
  });
}

FieldStudy study_of(const SampledField& field_nt, std::vector<StudyPlace> places,
                    const std::vector<FieldTable>& tables) {
  const FieldTable& chosen = chosen_of(tables, TableKind::Curvature);
  AttitudeStudy attitudes{tables, chosen};
  for (const StudyPlace& place : places) {
    attitudes.add(place);
  }
  FieldStudy study{
      .places = std::move(places),
      .tables = {},
      .weights = weights_of(field_nt),
      .uniform_error_nt = errors_of(chosen_of(tables, TableKind::Uniform), field_nt).mean_nt.sum(),
      .knots_rad = {chosen.knots_rad.begin(), chosen.knots_rad.end()},
      .attitudes = attitudes.attitudes(),
      .most = attitudes.most(),
      .places_in_line = attitudes.in_line()};
  for (std::size_t i = 0; i < tables.size(); ++i) {
    study.tables.push_back({.kind = tables[i].kind,
                            .points = static_cast<int>(tables[i].rows.size()),
                            .bytes = tables[i].bytes(),
                            .errors = errors_of(tables[i], field_nt),
                            .armse_rad = attitudes.armse_rad(i)});
  }
  return study;
}

}  // namespace

Expected<FieldStudy> study_tables(const KeplerOrbit& orbit, const MainField& field) {
  RevolutionField revolution{orbit, field};
  const FieldAlong along = [&](double behind_rad) { return revolution.at(behind_rad); };
  return sampled(along).and_then([&](const SampledField& field_nt) {
    return places_of(orbit, along).and_then([&](std::vector<StudyPlace>&& places) {
      return tables_of(along, orbit.true_anomaly_at_epoch_rad())
          .map([&](const std::vector<FieldTable>& tables) {
            return study_of(field_nt, std::move(places), tables);
          });
    });
  });
}

}  // namespace spindrift
