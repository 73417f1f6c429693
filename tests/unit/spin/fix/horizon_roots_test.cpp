#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/fix/axis_candidates.h"
#include "pipelines/spin/measurement/beam_view.h"
#include "tests/support/axis_scene.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::horizon_roots_test {

using Eigen::Vector3d;
using enum SpinQuantity;

/// Returns the axis with these angles to Sun and Earth, on the side of their plane that the
/// dihedral selects: the intersection of two cones, from three equations.
Vector3d axis_of(const SunEarthDirections& sun_earth, const AxisAngles& place) {
  const Vector3d& sun = sun_earth.sun_icrf;
  const Vector3d& earth = sun_earth.earth_icrf;
  Eigen::Matrix3d rows;
  rows << sun.transpose(), earth.transpose(), sun.cross(earth).transpose();
  const Vector3d in_plane = rows.inverse() * Vector3d{std::cos(place.sun_angle_rad.value()),
                                                      std::cos(place.earth_angle_rad.value()), 0.0};
  const double across = std::sqrt(std::max(0.0, 1.0 - in_plane.squaredNorm()));
  return in_plane + std::copysign(across, std::sin(place.dihedral_rad.value())) *
                        sun.cross(earth).normalized();
}

/// Holds the measurements of a revolution and the objects to which they refer.
struct Revolved {
  SpinConfig config;
  RevolutionMeasurements measured;
  SunEarthDirections sun_earth;

  explicit Revolved(const AxisScene& scene, const std::set<SpinQuantity>& left_out = {})
      : config{scene.config}, measured{scene.measured(left_out)}, sun_earth{scene.sun_earth()} {}

  FixInput on_sphere() const {
    return fix_input(config, measured, sun_earth, views_of_sphere(sun_earth));
  }
  AxisSolutions with_views_from(const Vector3d& axis_icrf) const {
    return solve_axis_angles(fix_input(config, measured, sun_earth,
                                       views_of_horizon(config, measured, sun_earth, axis_icrf)));
  }
  std::vector<Vector3d> axes_of(const AxisSolutions& solutions) const {
    std::vector<Vector3d> axes;
    for (const AxisAngles& place : solutions.places) {
      axes.push_back(axis_of(sun_earth, place));
    }
    return axes;
  }
};

double nearest_rad(const std::vector<Vector3d>& axes, const Vector3d& axis) {
  double nearest = kTurn_rad;
  for (const Vector3d& other : axes) {
    nearest = std::min(nearest, angle_between_rad(other, axis));
  }
  return nearest;
}

/// Quantities left out, so that all measurements remain, or one chord, or one chord with only the
/// Sun's azimuth or only its angle.
const std::vector<std::set<SpinQuantity>> kLeftOut = {
    {}, {SouthChord}, {NorthChord}, {SouthChord, SunAngle}, {NorthChord, SunAngle}};

using Check = std::function<void(const AxisScene& scene, const Revolved& revolved)>;

void for_all(HorizonModel earth, const Check& check) {
  for (const double tilt_deg : {0.0, 40.0, 80.0}) {
    for (const double earth_angle_deg : {80.0, 90.0, 97.0}) {
      const AxisScene scene = tilted_scene(tilt_deg, earth_angle_deg, earth);
      for (const auto& left_out : kLeftOut) {
        check(scene, Revolved{scene, left_out});
      }
    }
  }
}

TEST(HorizonRoots, TheTrueAxisIsAmongThem) {
  for (const HorizonModel earth : {HorizonModel::Sphere, HorizonModel::Ellipsoid}) {
    for_all(earth, [](const AxisScene& scene, const Revolved& revolved) {
      const AxisSolutions found = solve_on_horizon(revolved.on_sphere());
      EXPECT_LT(nearest_rad(revolved.axes_of(found), scene.axis_icrf), 10.0 * kExact_rad);
      if (found.told_apart) {
        EXPECT_LT(
            angle_between_rad(axis_of(revolved.sun_earth, found.places.front()), scene.axis_icrf),
            10.0 * kExact_rad);
      }
    });
  }
}

/// Linearised at a root, the horizon must lead to that root again, independently of the iteration.
TEST(HorizonRoots, EachIsWhatTheBeamsSeeFromIt) {
  for_all(HorizonModel::Ellipsoid, [](const AxisScene&, const Revolved& revolved) {
    const AxisSolutions found = solve_on_horizon(revolved.on_sphere());
    ASSERT_FALSE(found.places.empty());
    // Where two roots merge, the steps get small before they have converged.
    const double at_rest_rad = found.near_tangent ? 1e-5 : 1e-8;
    for (const Vector3d& root : revolved.axes_of(found)) {
      EXPECT_LT(nearest_rad(revolved.axes_of(revolved.with_views_from(root)), root), at_rest_rad);
    }
  });
}

TEST(HorizonRoots, OnASphereAtRestTheyAreThoseOfTheSphere) {
  for_all(HorizonModel::Sphere, [](const AxisScene&, const Revolved& revolved) {
    const auto on_sphere = revolved.axes_of(solve_axis_angles(revolved.on_sphere()));
    const auto found = revolved.axes_of(solve_on_horizon(revolved.on_sphere()));
    ASSERT_EQ(found.size(), on_sphere.size());
    for (const Vector3d& axis : found) {
      EXPECT_LT(nearest_rad(on_sphere, axis), 1e-8);
    }
  });
}

TEST(HorizonRoots, TheFlatteningMovesAGoodFixByAFifthOfADegreeOrLess) {
  double farthest_rad = 0.0;
  for_all(HorizonModel::Ellipsoid, [&](const AxisScene&, const Revolved& revolved) {
    const AxisSolutions found = solve_on_horizon(revolved.on_sphere());
    if (found.told_apart) {
      const auto on_sphere = revolved.axes_of(solve_axis_angles(revolved.on_sphere()));
      farthest_rad =
          std::max(farthest_rad, nearest_rad(on_sphere, revolved.axes_of(found).front()));
    }
  });
  EXPECT_GT(farthest_rad, 0.05 * kRadPerDeg);
  EXPECT_LT(farthest_rad, 0.2 * kRadPerDeg);
}

TEST(HorizonRoots, NoneIsThereTwice) {
  for_all(HorizonModel::Ellipsoid, [](const AxisScene&, const Revolved& revolved) {
    std::vector<Vector3d> roots = revolved.axes_of(solve_on_horizon(revolved.on_sphere()));
    while (roots.size() > 1) {
      const Vector3d last = roots.back();
      roots.pop_back();
      EXPECT_GT(nearest_rad(roots, last), 1e-6);
    }
  });
}

/// With one chord and an azimuth near the limb, the sphere has roots that the ellipsoid lacks and
/// the other way round.
TEST(HorizonRoots, WhereTheTrueOneIsMissingTheySayThatTheyAreNearTangent) {
  int missing = 0;
  int fewer = 0;
  for (const double tilt_deg : {0.0, 20.0, 40.0, 60.0, 80.0}) {
    for (const double earth_angle_deg : {84.0, 90.0, 94.0, 95.0, 96.0}) {
      const AxisScene scene = tilted_scene(tilt_deg, earth_angle_deg, HorizonModel::Ellipsoid);
      for (const SpinQuantity chord : {NorthChord, SouthChord}) {
        const Revolved revolved{scene, {chord, SunAngle}};
        const AxisSolutions found = solve_on_horizon(revolved.on_sphere());
        if (nearest_rad(revolved.axes_of(found), scene.axis_icrf) > 10.0 * kExact_rad) {
          ++missing;
          EXPECT_TRUE(found.near_tangent) << tilt_deg << " " << earth_angle_deg;
        }
        fewer +=
            found.places.size() < solve_axis_angles(revolved.on_sphere()).places.size() ? 1 : 0;
      }
    }
  }
  EXPECT_GT(missing, 0);
  EXPECT_GT(fewer, 0);
  EXPECT_LT(missing, 15);
}

TEST(HorizonRoots, WhereTheSphereHasNoneThereIsNoneAndTheReasonIsKept) {
  Revolved revolved{tilted_scene(40.0, 90.0, HorizonModel::Ellipsoid), {SouthChord, SunAngle}};
  // The disc is narrower than the chord.
  revolved.sun_earth.disc_rad = 5.0 * kRadPerDeg;
  const AxisSolutions on_sphere = solve_axis_angles(revolved.on_sphere());
  ASSERT_TRUE(on_sphere.reason);
  EXPECT_EQ(on_sphere.reason->code, NoFixCode::ChordTooWide);
  const AxisSolutions found = solve_on_horizon(revolved.on_sphere());
  EXPECT_TRUE(found.places.empty());
  ASSERT_TRUE(found.reason);
  EXPECT_EQ(*found.reason, *on_sphere.reason);
  EXPECT_FALSE(found.told_apart);
}

/// The disc shrinks until it is narrower than the chord.
TEST(HorizonRoots, WhereAllVanishOnTheWayThereIsNoneAndAReason) {
  Revolved revolved{tilted_scene(80.0, 90.0, HorizonModel::Ellipsoid), {SouthChord, SunAngle}};
  int vanished = 0;
  for (int i = 0; i < 600; ++i) {
    revolved.sun_earth.disc_rad -= 0.0025 * kRadPerDeg;
    const AxisSolutions found = solve_on_horizon(revolved.on_sphere());
    if (found.places.empty() && !solve_axis_angles(revolved.on_sphere()).places.empty()) {
      ++vanished;
      EXPECT_TRUE(found.reason);
      EXPECT_FALSE(found.told_apart);
    }
  }
  EXPECT_GT(vanished, 0);
}

}  // namespace spindrift::testing::horizon_roots_test
