#include "pipelines/frames/celestial.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/time/utc.h"
#include "services/mission/igrf.h"
#include "tests/support/matchers.h"

namespace spindrift::field_at_spacecraft_test {

using Eigen::Vector3d;

TEST(FieldAtSpacecraft, IsThatOfTheEarthBelow) {
  const MainFieldModel model = igrf().value();
  const TaiTime t = parse_utc("2026-05-01T12:34:56").value();
  const Vector3d position_icrf_km{3000.0, -5000.0, 4500.0};
  TurningEarth earth;
  const Vector3d field_nt = field_icrf_nt(model, t, position_icrf_km, earth).value();

  const Eigen::Quaterniond q_icrf_itrf = earth_orientation(t);
  const Vector3d expected_nt =
      q_icrf_itrf *
      model.at(decimal_year(t))->at(q_icrf_itrf.conjugate() * position_icrf_km).value();
  EXPECT_NEAR((field_nt - expected_nt).norm(), 0.0, 0.05);
}

TEST(FieldAtSpacecraft, IsRefusedOutsideTheYearsOfTheModel) {
  TurningEarth earth;
  EXPECT_THAT(field_icrf_nt(igrf().value(), parse_utc("2030-01-02T00:00:00").value(),
                            {7000.0, 0.0, 0.0}, earth),
              IsRefused(ErrorCode::NoCoverage, HasSubstr("known from 1900 to 2030")));
}

}  // namespace spindrift::field_at_spacecraft_test
