#include "services/products/to_json.h"

#include "services/products/products.h"
#include "tests/support/matchers.h"

namespace spindrift::to_json_test {

TEST(ProductToJson, HasTheColumnsOfTheTable) {
  const auto object = json_of(SpinMeasurement{
      .revolution = 3,
      .quantity = SpinQuantity::Period,
      .value = 0.5,
      .sigma = 0.25,
      .rejected_by = Rejection::Period,
      .said = Observation::of({}, SampleSource::Period, 0.25, 0.25, 0.125, Rejection::Period)});
  EXPECT_EQ(object, nlohmann::json::parse(R"({"revolution": 3, "quantity": "period", "value": 0.5,
      "unit": "s", "sigma": 0.25, "accepted": false, "rejected_by": "period",
      "expected": 0.25, "limit": 0.125})"));
}

TEST(ProductToJson, WhatHasNoValueIsNull) {
  const auto object = json_of(PulseUse{});
  EXPECT_TRUE(object.at("revolution").is_null());
  EXPECT_TRUE(object.at("rejected_by").is_null());
  EXPECT_EQ(object.at("accepted"), true);
}

}  // namespace spindrift::to_json_test
