#include "pipelines/geomagnetism/tables/table_study.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "pipelines/ephemeris/flight_frames.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/geomagnetism/tables/curvature_knots.h"
#include "pipelines/three_axis/attitude_from_vectors.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

constexpr int kRuns = 50;
constexpr int kPlaces = 589;  // Ten seconds apart in a low orbit.
constexpr double kFieldNoise_nt = 10.0;
constexpr double kSunNoise = 0.01;
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

/// Sun and field as the body measures them.
struct Measured {
  Vector3d sun_body;
  Vector3d field_body_nt;
};

/// Returns the attitude by TRIAD. The Sun comes first, as in the paper.
Expected<Eigen::Quaterniond> attitude_of(const StudyPlace& place, const Measured& measured,
                                         const Vector3d& field_ref_nt) {
  return triad({.body = measured.sun_body, .ref = place.sun_orbit, .sigma_rad = kSunNoise},
               {.body = measured.field_body_nt,
                .ref = field_ref_nt,
                .sigma_rad = kFieldNoise_nt / field_ref_nt.norm()})
      .map([](const UncertainAttitude& attitude) { return attitude.q_ref_body; });
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
  Measured measure(const StudyPlace& place) {
    const auto noise = [this] { return Vector3d{normal_(rng_), normal_(rng_), normal_(rng_)}; };
    return {.sun_body = place.sun_orbit + kSunNoise * noise(),
            .field_body_nt = place.field_orbit_nt + kFieldNoise_nt * noise()};
  }

  /// @return False where Sun and field are in line.
  bool add_run(const StudyPlace& place, int run, std::vector<Vector3d>& squares) {
    const Measured measured = measure(place);
    const auto with_field = attitude_of(place, measured, place.field_orbit_nt);
    const auto with_table = [&](const FieldTable& table) {
      return attitude_of(place, measured, lookup(table, place.behind_first_rad));
    };
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

}  // namespace

Expected<FieldStudy> study_tables(const KeplerOrbit& orbit, const MainField& field) {
  RevolutionField revolution{orbit, field};
  const FieldAlong along = [&](double behind_rad) { return revolution.at(behind_rad); };
  const auto truth_nt = sampled(along);
  auto places = places_of(orbit, along);
  if (!truth_nt || !places) {
    return Unexpected{truth_nt ? places.error() : truth_nt.error()};
  }
  std::vector<FieldTable> tables;
  FieldStudy study;
  for (const TableKind kind : kTableKinds) {
    for (const int points : kStudiedPoints) {
      auto table = make_table(along, kind, orbit.true_anomaly_at_epoch_rad(), points);
      if (!table) {
        return Unexpected{table.error()};
      }
      study.tables.push_back({.kind = kind,
                              .points = points,
                              .bytes = table->bytes(),
                              .errors = errors_of(*table, *truth_nt),
                              .armse_rad = Vector3d::Zero()});
      tables.push_back(std::move(*table));
    }
  }
  const auto is_chosen = [](TableKind kind) {
    return [kind](const StudiedTable& is) { return is.kind == kind && is.points == kChosenPoints; };
  };
  const auto chosen = static_cast<std::size_t>(
      std::find_if(study.tables.begin(), study.tables.end(), is_chosen(TableKind::Curvature)) -
      study.tables.begin());
  AttitudeStudy attitudes{tables, tables[chosen]};
  for (const StudyPlace& place : *places) {
    attitudes.add(place);
  }
  for (std::size_t i = 0; i < tables.size(); ++i) {
    study.tables[i].armse_rad = attitudes.armse_rad(i);
  }
  study.attitudes = attitudes.attitudes();
  study.most = attitudes.most();
  study.places_in_line = attitudes.in_line();
  study.knots_rad.assign(tables[chosen].knots_rad.begin(), tables[chosen].knots_rad.end());
  study.weights = weights_of(*truth_nt);
  study.uniform_error_nt =
      std::find_if(study.tables.begin(), study.tables.end(), is_chosen(TableKind::Uniform))
          ->errors.mean_nt.sum();
  study.places = std::move(*places);
  return study;
}

}  // namespace spindrift
