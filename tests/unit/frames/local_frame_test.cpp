#include "pipelines/frames/local_frame.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/wgs84.h"
#include "tests/support/matchers.h"

namespace spindrift::local_frame_test {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr GeodeticPlace kTaiyuan{
    .latitude_rad = 38.849 * kRadPerDeg, .longitude_rad = 111.608 * kRadPerDeg, .height_km = 1.4};

Vector3d origin_of(const GeodeticPlace& place) { return local_frame(place)->origin_itrf_km; }

TEST(LocalFrame, NorthEastDownAreTheEllipsoidsOwn) {
  constexpr double kStep_rad = 1e-6;
  GeodeticPlace northern = kTaiyuan;
  GeodeticPlace eastern = kTaiyuan;
  northern.latitude_rad += kStep_rad;
  eastern.longitude_rad += kStep_rad;
  const Vector3d here = origin_of(kTaiyuan);
  const Vector3d north = origin_of(northern) - here;
  const Vector3d east = origin_of(eastern) - here;
  const Eigen::Matrix3d R = local_frame(kTaiyuan)->q_itrf_ned.toRotationMatrix();
  EXPECT_NEAR((R.col(0) - north.normalized()).norm(), 0.0, 2e-6);
  EXPECT_NEAR((R.col(1) - east.normalized()).norm(), 0.0, 2e-6);
  EXPECT_NEAR((R.col(2) - north.cross(east).normalized()).norm(), 0.0, 2e-6);
  // The latitude is geodetic, so the vertical misses the Earth's centre by 11 arcmin.
  EXPECT_NEAR(degrees(std::acos(-R.col(2).dot(here.normalized()))) * 60.0, 11.3, 0.2);
}

TEST(LocalFrame, StandsOnTheEllipsoidAtHeightZero) {
  for (const double latitude_deg : {-90.0, -45.0, 0.0, 12.5, 90.0}) {
    const Vector3d on_it = origin_of({latitude_deg * kRadPerDeg, 2.0, 0.0});
    const Vector3d in_axes{on_it.x() / wgs84::kEquatorialRadius_km,
                           on_it.y() / wgs84::kEquatorialRadius_km,
                           on_it.z() / wgs84::kPolarRadius_km};
    EXPECT_NEAR(in_axes.norm(), 1.0, 1e-14) << latitude_deg;
    const LocalFrame above =
        local_frame(GeodeticPlace{latitude_deg * kRadPerDeg, 2.0, 500.0}).value();
    EXPECT_NEAR(
        (above.origin_itrf_km - on_it + above.q_itrf_ned * Vector3d{0.0, 0.0, 500.0}).norm(), 0.0,
        1e-11);
  }
}

TEST(LocalFrame, LooksDownToTheEarthsCentreFromAGeocentricPlace) {
  const LocalFrame frame = local_frame(GeocentricPlace{0.5, -2.0, 7000.0}).value();
  const Vector3d expected_km = 7000.0 * Vector3d{std::cos(0.5) * std::cos(-2.0),
                                                 std::cos(0.5) * std::sin(-2.0), std::sin(0.5)};
  EXPECT_NEAR((frame.origin_itrf_km - expected_km).norm(), 0.0, 1e-11);
  EXPECT_NEAR((frame.q_itrf_ned * Vector3d::UnitZ() + expected_km.normalized()).norm(), 0.0, 1e-15);
}

TEST(LocalFrame, IsRefusedBeyondThePoles) {
  for (const double latitude_deg : {90.0001, -91.0, kNan}) {
    EXPECT_THAT(
        local_frame(GeodeticPlace{latitude_deg * kRadPerDeg, 0.0, 0.0}),
        IsRefused(ErrorCode::InvalidInput, AllOf(HasSubstr("latitude"), HasSubstr("[-90, 90]"))));
  }
}

TEST(LocalFrame, IsRefusedForWhatIsNoNumber) {
  EXPECT_FALSE(local_frame(GeodeticPlace{0.0, kNan, 0.0}));
  EXPECT_FALSE(local_frame(GeodeticPlace{0.0, 0.0, kNan}));
  EXPECT_FALSE(local_frame(GeocentricPlace{kNan, 0.0, 7000.0}));
  EXPECT_FALSE(local_frame(GeocentricPlace{0.0, 0.0, std::numeric_limits<double>::infinity()}));
}

}  // namespace spindrift::local_frame_test
