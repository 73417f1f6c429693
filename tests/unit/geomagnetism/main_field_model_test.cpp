#include <Eigen/Dense>
#include <limits>

#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/time/utc.h"
#include "services/mission/igrf.h"
#include "tests/support/matchers.h"

namespace spindrift::main_field_model_test {

using Eigen::Vector3d;

const Vector3d kPosition_km{-2000.0, 4800.0, 4700.0};

Vector3d field_nt(const MainFieldModel& model, double year, int degree = kHighestDegree) {
  return model.at(year, degree).value().at(kPosition_km).value();
}

TEST(MainFieldModel, ReachesFrom1900To2030) {
  const MainFieldModel model = igrf().value();
  EXPECT_EQ(model.first_year(), 1900.0);
  EXPECT_EQ(model.last_year(), 2030.0);
  EXPECT_TRUE(model.at(1900.0));
  EXPECT_TRUE(model.at(2030.0));
  for (const double year :
       {1899.999, 2030.001, -2020.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(model.at(year),
                IsRefused(ErrorCode::NoCoverage, HasSubstr("known from 1900 to 2030")))
        << year;
  }
}

TEST(MainFieldModel, KnowsDegrees1To13) {
  const MainFieldModel model = igrf().value();
  EXPECT_TRUE(model.at(2020.0, 1));
  EXPECT_TRUE(model.at(2020.0, 13));
  for (const int degree : {-1, 0, 14}) {
    EXPECT_THAT(model.at(2020.0, degree),
                IsRefused(ErrorCode::InvalidInput, HasSubstr("must be 1 to 13")))
        << degree;
  }
  // Epochs up to 1995 have degrees up to 10.
  EXPECT_EQ(field_nt(model, 1990.0, 10), field_nt(model, 1990.0, 13));
  EXPECT_GT((field_nt(model, 2010.0, 10) - field_nt(model, 2010.0, 13)).norm(), 1.0);
}

TEST(DecimalYear, AndInstantAreEachOthersInverse) {
  const TaiTime new_year_2030 = tai_from_ns(1'893'456'000'000'000'000);
  EXPECT_EQ(instant_of_year(2030.0), new_year_2030);
  EXPECT_EQ(instant_of_year(1970.0), tai_from_ns(0));
  EXPECT_EQ(instant_of_year(2024.5) - instant_of_year(2024.0), std::chrono::days{183});
  EXPECT_EQ(instant_of_year(1901.0) - instant_of_year(1900.0), std::chrono::days{365});
  for (const double year : {1900.25, 1969.75, 1999.0, 2026.875}) {
    EXPECT_NEAR(decimal_year(instant_of_year(year)), year, 1e-12);
  }
}

TEST(MainFieldModel, ChangesEvenlyBetweenEpochs) {
  const MainFieldModel model = igrf().value();
  for (const double epoch : {1900.0, 1995.0, 2015.0, 2020.0, 2025.0}) {
    const Vector3d from_nt = field_nt(model, epoch);
    const Vector3d to_nt = field_nt(model, epoch + 5.0);
    EXPECT_NEAR((field_nt(model, epoch + 2.0) - (0.6 * from_nt + 0.4 * to_nt)).norm(), 0.0, 1e-9);
  }
}

TEST(MainFieldModel, DoesNotJumpAtAnEpoch) {
  const MainFieldModel model = igrf().value();
  for (double epoch = 1905.0; epoch < 2030.0; epoch += 5.0) {
    constexpr double kStep = 1e-7;
    // The field changes by at most 300 nT a year.
    EXPECT_LT((field_nt(model, epoch + kStep) - field_nt(model, epoch - kStep)).norm(), 6e-5)
        << epoch;
    EXPECT_LT((field_nt(model, epoch) - field_nt(model, epoch - kStep)).norm(), 3e-5) << epoch;
  }
}

TEST(MainFieldModel, NeedsEpochsInOrder) {
  const auto refused = [](std::vector<FieldEpoch> epochs) {
    const auto model = MainFieldModel::make(std::move(epochs));
    return model ? std::string{} : model.error().message;
  };
  EXPECT_THAT(refused({}), HasSubstr("0 epochs: at least 2"));
  EXPECT_THAT(refused({{2000.0, {}}}), HasSubstr("1 epochs: at least 2"));
  EXPECT_THAT(refused({{2000.0, {}}, {2000.0, {}}}), HasSubstr("2000 behind 2000"));
  EXPECT_EQ(refused({{2000.0, {}}, {2005.0, {}}}), "");
}

TEST(DecimalYear, IsTheYearAndItsPart) {
  EXPECT_EQ(decimal_year(parse_tai("2010-01-01T00:00:00").value()), 2010.0);
  EXPECT_NEAR(decimal_year(parse_tai("2023-07-02T12:00:00").value()), 2023.5, 1e-12);
  EXPECT_NEAR(decimal_year(parse_tai("2024-12-31T00:00:00").value()), 2024.0 + 365.0 / 366.0,
              1e-12);
  EXPECT_NEAR(decimal_year(parse_tai("1969-12-31T23:59:59").value()), 1970.0 - 1.0 / 31'536'000.0,
              1e-12);
  EXPECT_LT(decimal_year(parse_tai("1999-12-31T23:59:59").value()), 2000.0);
}

}  // namespace spindrift::main_field_model_test
