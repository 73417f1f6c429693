#include "pipelines/three_axis/attitude_gates.h"

#include <iterator>
#include <limits>
#include <random>
#include <variant>
#include <vector>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/three_axis/three_axis_pass.h"
#include "tests/support/commanded_flight.h"
#include "tests/support/matchers.h"
#include "tests/support/of_kind.h"

namespace spindrift::testing::attitude_gates_test {

using Products = AttitudeGates::Products;

NominalAttitude commanded_in_icrf() {
  return {
      .frame = NominalAttitude::Frame::Icrf,
      .q_frame_body = Eigen::Quaterniond{Eigen::AngleAxisd{1.0, Eigen::Vector3d{1, 2, 2} / 3.0}}};
}

/// Returns a direction in body axes that is off its nominal place.
Eigen::Vector3d seen(const Eigen::Vector3d& icrf, double off_deg) {
  const Eigen::Vector3d body = commanded_in_icrf().q_frame_body.conjugate() * icrf;
  return Eigen::AngleAxisd{off_deg * kRadPerDeg, body.unitOrthogonal()} * body;
}

const Eigen::Vector3d kField_nt{10'000.0, -20'000.0, 30'000.0};
const Expected<OrbitState> kNowhere = Unexpected{{ErrorCode::NoCoverage, {}}};

std::vector<GateTransition> transitions(const Products& products) {
  return of_kind<GateTransition>(products);
}

/// Returns a value by name; empty if there is none.
std::optional<double> value(const GateTransition& transition, std::string_view name) {
  for (const NamedValue& one : transition.more) {
    if (one.name == name) {
      const auto* const count = std::get_if<std::int64_t>(&one.value);
      return count != nullptr ? static_cast<double>(*count) : std::get<double>(one.value);
    }
  }
  return std::nullopt;
}

/// Returns the transitions of `lost` by twenty fields, with Suns unless there is no angle.
std::vector<GateTransition> lost_by(double field_deg, std::optional<double> sun_deg) {
  AttitudeGates gates{commanded_in_icrf()};
  Products out;
  for (int second = 0; second < 20; ++second) {
    if (sun_deg) {
      gates.see_sun(at_s(second), seen(Eigen::Vector3d::UnitX(), *sun_deg),
                    Eigen::Vector3d::UnitX(), kNowhere);
    }
    gates.see_field(at_s(second), seen(kField_nt, field_deg), kField_nt, kNowhere, out);
  }
  return transitions(out);
}

TEST(LostGate, OpensWhereTheFieldIsMoreThanFiveDegreesOff) {
  EXPECT_THAT(lost_by(4.9, 20.0), IsEmpty());
  const auto lost = lost_by(5.1, std::nullopt);
  ASSERT_THAT(lost, SizeIs(1));
  EXPECT_EQ(lost[0].gate, Gate::Lost);
  EXPECT_TRUE(lost[0].open);
  EXPECT_EQ(lost[0].t, at_s(9));
  EXPECT_EQ(lost[0].since, at_s(0));
  EXPECT_NEAR(lost[0].value, 5.1, 1e-9);
  EXPECT_EQ(lost[0].hits, 10);
  EXPECT_EQ(lost[0].window, 10);
  EXPECT_EQ(value(lost[0], "certain"), 0.0);
  EXPECT_FALSE(value(lost[0], "sun_deg"));
}

TEST(LostGate, IsCertainIfTheSunSaysTheSame) {
  EXPECT_EQ(value(lost_by(8.0, 4.0).at(0), "certain"), 0.0);
  const auto lost = lost_by(8.0, 6.0);
  EXPECT_EQ(value(lost.at(0), "certain"), 1.0);
  EXPECT_NEAR(value(lost.at(0), "sun_deg").value(), 6.0, 1e-9);
}

TEST(LostGate, IsNotWithoutACommandedAttitudeOrItsFrame) {
  for (const auto& nominal :
       {std::optional<NominalAttitude>{}, std::optional{CommandedFlight::commanded()}}) {
    AttitudeGates gates{nominal};
    Products out;
    for (int second = 0; second < 20; ++second) {
      gates.see_field(at_s(second), seen(kField_nt, 90.0), kField_nt, kNowhere, out);
    }
    EXPECT_THAT(out, IsEmpty());
  }
}

TEST(ReachedGate, OpensWhereTheAttitudeInForceIsTheCommandedOne) {
  AttitudeGates gates{commanded_in_icrf()};
  Products out;
  const auto tell = [&](int second, double off_deg, Quality quality) {
    AttitudeEstimate estimate{.t = at_s(second),
                              .q_icrf_body = commanded_in_icrf().q_frame_body,
                              .rate_body_rad_s = std::nullopt,
                              .covariance_rad2 = Eigen::Matrix3d::Identity() * 1e-4,
                              .assessment = {.quality = quality}};
    estimate.q_icrf_body =
        estimate.q_icrf_body * Eigen::AngleAxisd{off_deg * kRadPerDeg, Eigen::Vector3d::UnitY()};
    gates.see(estimate, kNowhere, out);
  };
  for (int second = 0; second < 20; ++second) {
    tell(second, 6.1, Quality::Ok);
  }
  for (int second = 20; second < 40; ++second) {
    tell(second, 0.0, Quality::Lost);
  }
  ASSERT_THAT(out, IsEmpty());
  for (int second = 40; second < 50; ++second) {
    tell(second, 5.9, Quality::Ok);
  }
  const auto reached = transitions(out);
  ASSERT_THAT(reached, SizeIs(1));
  EXPECT_EQ(reached[0].gate, Gate::Reached);
  EXPECT_EQ(reached[0].t, at_s(49));
  EXPECT_NEAR(reached[0].value, 5.9, 1e-9);
}

TEST(UsableGate, OpensWhereInnovationsAreBelowAThousandNanotesla) {
  const auto opens = [](const Eigen::Vector3d& off_nt) {
    AttitudeGates gates{std::nullopt};
    Products out;
    for (int second = 0; second < 30; ++second) {
      gates.see_innovation({.t = at_s(second),
                            .source = SampleSource::Magnetometer,
                            .residual = {.freedom = 3, .value = off_nt}},
                           out);
    }
    return gates.is_open(Gate::Usable);
  };
  EXPECT_TRUE(opens({599.0, 0.0, 800.0}));
  EXPECT_FALSE(opens({601.0, 0.0, 800.0})) << "the norm counts";
}

constexpr double kNone_nats = std::numeric_limits<double>::infinity();

/// Returns whether ten minutes of such readings open the gate.
bool opens(const WinnerReading& reading) {
  AttitudeGates gates{std::nullopt};
  Products out;
  for (int second = 0; second <= 600; second += 10) {
    WinnerReading now = reading;
    now.t = at_s(second);
    gates.see(now, out);
  }
  return gates.is_open(Gate::Safe);
}

TEST(SafeGate, OpensIfAllItsConditionsHold) {
  const WinnerReading good{.t = {}, .nis = 3.9, .sigma_rad = 4.9 * kRadPerDeg, .lead_nats = 50.0};
  EXPECT_TRUE(opens(good));
  EXPECT_TRUE(opens({.t = {}, .nis = 3.9, .sigma_rad = 0.01, .lead_nats = kNone_nats}));
  for (const auto member : {&WinnerReading::nis, &WinnerReading::sigma_rad}) {
    WinnerReading bad = good;
    bad.*member *= 1.05;
    EXPECT_FALSE(opens(bad));
  }
  WinnerReading followed = good;
  followed.lead_nats = 49.0;
  EXPECT_FALSE(opens(followed));
}

TEST(SafeGate, HoldsTheMeanOfTheLastTenMinutesToItsLimit) {
  AttitudeGates gates{std::nullopt};
  Products out;
  const auto give = [&](int from_s, int to_s, double nis) {
    for (int t_s = from_s; t_s < to_s; t_s += 10) {
      gates.see({.t = at_s(t_s), .nis = nis, .sigma_rad = 0.01, .lead_nats = 60.0}, out);
    }
  };
  // Ten minutes of large innovations, which are forgotten after ten more; then a window.
  give(0, 600, 20.0);
  give(600, 1'680, 2.0);
  EXPECT_FALSE(gates.is_open(Gate::Safe)) << "a window cannot have begun before the mean was small";
  give(1'680, 1'800, 2.0);
  ASSERT_TRUE(gates.is_open(Gate::Safe));
  const auto safe = transitions(out);
  EXPECT_NEAR(value(safe.at(0), "mean_nis").value(), 2.0, 1e-9);
  give(1'800, 2'400, 8.0);
  EXPECT_FALSE(gates.is_open(Gate::Safe));
}

/// A flight through the whole pass.
class CommandedPassTest : public ::testing::Test {
 protected:
  void add(ThreeAxisOutput output) {
    std::move(output.products.begin(), output.products.end(), std::back_inserter(products_));
  }
  void fly(int from_s, int to_s, double departed_deg) {
    for (int second = from_s; second < to_s; ++second) {
      add(pass_.push(flight_.field(second, departed_deg * kRadPerDeg)));
    }
  }
  std::vector<GateTransition> lost() const {
    auto all = transitions(products_);
    std::erase_if(all, [](const GateTransition& one) { return one.gate != Gate::Lost; });
    return all;
  }

  std::mt19937_64 rng_{17};
  CommandedFlight flight_{rng_, 1.0 * kRadPerDeg, 300.0};
  ThreeAxisPass pass_{flight_.config(), flight_.orbit(), flight_.model()};
  Products products_;
};

TEST_F(CommandedPassTest, IsLostByTheFieldAloneAndRecovers) {
  fly(0, 100, 0.0);
  fly(100, 160, 10.0);
  fly(160, 200, 0.0);
  add(pass_.finish());
  ASSERT_THAT(lost(), SizeIs(2));
  EXPECT_TRUE(lost()[0].open);
  EXPECT_EQ(lost()[0].t, at_s(109));
  EXPECT_FALSE(lost()[1].open);
  EXPECT_EQ(lost()[1].t, at_s(169));
}

TEST_F(CommandedPassTest, IsNotLostByAMagnetometerThatIsStuck) {
  fly(0, 100, 0.0);
  MagneticField stuck = flight_.field(100.0);
  for (int second = 100; second < 1000; ++second) {
    stuck.t = at_s(second);
    add(pass_.push(stuck));
  }
  add(pass_.finish());
  EXPECT_THAT(lost(), IsEmpty());
}

TEST_F(CommandedPassTest, IsNotLostByFieldsThatAnOperatorLeavesOut) {
  pass_.act(at_s(50.0), ExcludeChannel<SampleKind>{SampleKind::Magnetometer});
  fly(0, 50, 0.0);
  fly(50, 100, 20.0);
  add(pass_.finish());
  EXPECT_THAT(lost(), IsEmpty());
}

TEST_F(CommandedPassTest, TheSunConfirmsThatItIsLost) {
  ApparentSun sun;
  // Half a revolution behind the start the Sun is not in the Earth's shadow.
  for (int second = 2'930; second < 2'960; ++second) {
    const OrbitState spacecraft = flight_.orbit().at(at_s(second)).value();
    const Eigen::Vector3d sun_body =
        flight_.q_icrf_body(second).conjugate() * sun.direction_icrf(at_s(second), spacecraft);
    add(pass_.push(
        SunDirection{.t = at_s(second),
                     .sun_body = Eigen::AngleAxisd{0.3, sun_body.unitOrthogonal()} * sun_body}));
    fly(second, second + 1, 20.0);
  }
  add(pass_.finish());
  ASSERT_THAT(lost(), SizeIs(1));
  EXPECT_EQ(value(lost()[0], "certain"), 1.0);
  EXPECT_NEAR(value(lost()[0], "sun_deg").value(), degrees(0.3), 1.0);
}

}  // namespace spindrift::testing::attitude_gates_test
