#include "pipelines/three_axis/three_axis_pass.h"

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/ephemeris/shadow.h"
#include "pipelines/geomagnetism/field_at_spacecraft.h"

namespace spindrift {

std::chrono::nanoseconds reorder_horizon(const OrderedSample& /*sample*/) {
  return std::chrono::seconds{1};
}

ThreeAxisPass::ThreeAxisPass(const ThreeAxisConfig& config, std::optional<Orbit> orbit,
                             std::optional<MainFieldModel> field)
    : config_{config},
      orbit_{std::move(orbit)},
      orbit_is_of_mission_{orbit_.has_value()},
      field_{std::move(field)},
      estimator_{config} {}

ThreeAxisOutput ThreeAxisPass::take(const OrderedSample& sample) {
  ThreeAxisOutput out;
  if (!has_sensor(sample.kind())) {
    leave_out(sample, SampleRejection::NoSensor, out);
    return out;
  }
  using Verdict = BasicReorderWindow<OrderedSample>::Verdict;
  switch (window_.add(sample)) {
    case Verdict::Late:
      leave_out(sample, SampleRejection::Late, out);
      say_once(Notice{NoticeCode::LateSamples, {}}, out);
      break;
    case Verdict::OutOfTime:
      leave_out(sample, SampleRejection::OutOfTime, out);
      say_once(Notice{NoticeCode::SamplesOutOfTime, {}}, out);
      break;
    case Verdict::Held:
    case Verdict::Duplicate:
      break;
  }
  compute(window_.release(), out);
  return out;
}

void ThreeAxisPass::act(TaiTime t, const AttitudeAction& action) {
  std::visit([&](const auto& what) { excluded_.add(t, what); }, action);
}

ThreeAxisOutput ThreeAxisPass::fall_silent() {
  ThreeAxisOutput out;
  compute(window_.fall_silent(), out);
  estimator_.settle(out.products);
  return out;
}

ThreeAxisOutput ThreeAxisPass::finish() {
  ThreeAxisOutput out;
  const auto rest = window_.release_all();
  for (const OrderedSample& sample : rest.out_of_time) {
    leave_out(sample, SampleRejection::OutOfTime, out);
    say_once(Notice{NoticeCode::SamplesOutOfTime, {}}, out);
  }
  compute(rest.in_time, out);
  estimator_.settle(out.products);
  if (!estimator_.ever_began()) {
    const auto accepted = [this](SampleKind kind) {
      return estimator_.sensors().at(index_of(kind)).accepted;
    };
    say_once({NoticeCode::AttitudeNeverBegan,
              {{"gyro", accepted(SampleKind::Gyro)},
               {"star", accepted(SampleKind::Star)},
               {"sun", accepted(SampleKind::Sun)},
               {"magnetometer", accepted(SampleKind::Magnetometer)}}},
             out);
  }
  return out;
}

void ThreeAxisPass::compute(const std::vector<OrderedSample>& in_order, ThreeAxisOutput& out) {
  for (const OrderedSample& sample : in_order) {
    if (excluded_.hold(sample.t, sample.kind())) {
      leave_out(sample, SampleRejection::Operator, out);
    } else {
      std::visit([&](const auto& is) { compute(is, out); }, sample.is);
    }
  }
}

/// The newest one counts: those before it are behind the samples that come.
void ThreeAxisPass::compute(const TimedOrbitState& state, ThreeAxisOutput& out) {
  const auto orbit = KeplerOrbit::through(state.t, state.state);
  if (!orbit) {
    leave_out({state.t, state}, SampleRejection::NoOrbit, out);
  } else if (!orbit_is_of_mission_) {
    orbit_ = Orbit{*orbit};
    estimator_.note_accepted(SampleKind::OrbitState, state.t);
  }
}

void ThreeAxisPass::compute(const GyroSample& sample, ThreeAxisOutput& out) {
  estimator_.push(sample, out.products);
}

void ThreeAxisPass::compute(const StarFix& fix, ThreeAxisOutput& out) {
  estimator_.push(fix, out.products);
}

Expected<OrbitState> ThreeAxisPass::spacecraft_at(TaiTime t) const {
  return orbit_ ? orbit_->at(t) : Unexpected{{ErrorCode::NoCoverage, {}}};
}

void ThreeAxisPass::compute(const SunDirection& sun, ThreeAxisOutput& out) {
  const auto spacecraft = spacecraft_at(sun.t);
  constexpr auto kAtEarth = [] {
    return OrbitState{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  };
  const Eigen::Vector3d sun_icrf = sun_.direction_icrf(sun.t, spacecraft.value_or(kAtEarth()));
  if (spacecraft && is_in_shadow(spacecraft->position_icrf_km, sun_icrf)) {
    leave_out({sun.t, sun}, SampleRejection::Shadow, out);
    return;
  }
  estimator_.push(SeenDirection{.t = sun.t,
                                .kind = SampleKind::Sun,
                                .direction = {.body = sun.sun_body,
                                              .ref = sun_icrf,
                                              .sigma_rad = config_.sun_sensor->noise_rad}},
                  out.products);
}

void ThreeAxisPass::compute(const MagneticField& field, ThreeAxisOutput& out) {
  const auto spacecraft = spacecraft_at(field.t);
  if (!spacecraft) {
    leave_out({field.t, field}, SampleRejection::NoOrbit, out);
    say_once({NoticeCode::FieldWithoutOrbit, {{"t_tai_ns", tai_ns(field.t)}}}, out);
    return;
  }
  const auto known_icrf_nt =
      field_ ? field_icrf_nt(*field_, field.t, spacecraft->position_icrf_km, earth_)
             : Unexpected{{ErrorCode::NoCoverage, {}}};
  if (!known_icrf_nt) {
    leave_out({field.t, field}, SampleRejection::NoField, out);
    say_once({NoticeCode::OutsideFieldModel, {{"t_tai_ns", tai_ns(field.t)}}}, out);
    return;
  }
  const double noise_nt = config_.magnetometer->noise_nt;
  const double strength_nt = known_icrf_nt->norm();
  estimator_.push(SeenDirection{.t = field.t,
                                .kind = SampleKind::Magnetometer,
                                .direction = {.body = field.field_body_nt,
                                              .ref = *known_icrf_nt,
                                              .sigma_rad = noise_nt / strength_nt},
                                .stronger = (field.field_body_nt.norm() - strength_nt) / noise_nt},
                  out.products);
}

void ThreeAxisPass::leave_out(const OrderedSample& sample, SampleRejection rejected_by,
                              ThreeAxisOutput& out) {
  estimator_.leave_out({.t = sample.t, .kind = sample.kind(), .rejected_by = rejected_by},
                       out.products);
}

bool ThreeAxisPass::has_sensor(SampleKind kind) const {
  switch (kind) {
    case SampleKind::Gyro:
      return config_.gyro.has_value();
    case SampleKind::Star:
      return config_.star_tracker.has_value();
    case SampleKind::Sun:
      return config_.sun_sensor.has_value();
    case SampleKind::Magnetometer:
      return config_.magnetometer.has_value();
    case SampleKind::OrbitState:
      break;
  }
  return true;
}

void ThreeAxisPass::say_once(Notice notice, ThreeAxisOutput& out) {
  if (said_.insert(notice.code).second) {
    out.notices.push_back(std::move(notice));
  }
}

}  // namespace spindrift
