#include "pipelines/three_axis/three_axis_pass.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/named_equations.h"

namespace spindrift {

std::chrono::nanoseconds reorder_horizon(const OrderedSample& /*sample*/) {
  return std::chrono::seconds{1};
}

ThreeAxisPass::ThreeAxisPass(const ThreeAxisConfig& config, std::optional<Orbit> orbit,
                             std::optional<MainFieldModel> field)
    : config_{config},
      orbit_{std::move(orbit)},
      orbit_is_of_mission_{orbit_.has_value()},
      orbit_steps_{orbit_ ? orbit_steps(*orbit_) : std::vector<OrbitStep>{}},
      field_{std::move(field)},
      estimator_{config},
      gates_{config.nominal} {}

ThreeAxisOutput ThreeAxisPass::process(const OrderedSample& sample) {
  ThreeAxisOutput out;
  if (!has_sensor(sample.kind())) {
    leave_out(sample, Rejection::NoSensor, out);
    return out;
  }
  using Verdict = BasicReorderWindow<OrderedSample>::Verdict;
  switch (window_.offer(sample)) {
    case Verdict::Late:
      leave_out(sample, Rejection::Late, out);
      say_once(Notice{NoticeCode::LateSamples, {}}, out);
      break;
    case Verdict::OutOfTime:
      leave_out(sample, Rejection::OutOfTime, out);
      say_once(Notice{NoticeCode::SamplesOutOfTime, {}}, out);
      break;
    case Verdict::Duplicate:
      compare(sample, out);
      break;
    case Verdict::Held:
      break;
  }
  compute(window_.release(), out);
  doubt_where_orbit_steps(out);
  say_what_is_left_out(out);
  return out;
}

/// Reports late samples that contradict a processed one; the result computed from that one stands.
void ThreeAxisPass::compare(const OrderedSample& again, ThreeAxisOutput& out) {
  const auto known = window_.find(again);
  if (!known.released) {
    contested_.record(*known.sample, again);
  } else if (!say_the_same(*known.sample, again)) {
    out.products.emplace_back(SampleContradiction{.t = again.t,
                                                  .kind = name_of(again.kind()),
                                                  .by = late_senders(*known.sample, again),
                                                  .late = true});
  }
}

/// @return The sample that counts among all those contending with `due`; empty if none does.
std::optional<OrderedSample> ThreeAxisPass::settled(const OrderedSample& due,
                                                    ThreeAxisOutput& out) {
  const std::vector<OrderedSample> said = contested_.release(due);
  if (!is_contested(said)) {
    return due;
  }
  auto used = one_that_counts(said);
  out.products.emplace_back(
      SampleContradiction{.t = due.t, .kind = name_of(due.kind()), .by = senders_of(said, used)});
  return used;
}

void ThreeAxisPass::act(TaiTime t, const AttitudeAction& action) {
  std::visit([&](const auto& what) { excluded_.apply(t, what); }, action);
}

ThreeAxisOutput ThreeAxisPass::fall_silent() {
  ThreeAxisOutput out;
  compute(window_.fall_silent(), out);
  settle(out);
  tell_of_mission(out);
  doubt_where_orbit_steps(out);
  say_what_is_left_out(out);
  return out;
}

ThreeAxisOutput ThreeAxisPass::finish() {
  ThreeAxisOutput out;
  const auto rest = window_.release_all();
  for (const OrderedSample& sample : rest.out_of_time) {
    leave_out(sample, Rejection::OutOfTime, out);
    say_once(Notice{NoticeCode::SamplesOutOfTime, {}}, out);
  }
  compute(rest.in_time, out);
  settle(out);
  tell_of_mission(out);
  doubt_where_orbit_steps(out);
  say_what_is_left_out(out);
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
    const std::size_t from = out.products.size();
    reached_ = sample.t;
    const auto used = settled(sample, out);
    if (excluded_.hold(sample.t, sample.kind())) {
      leave_out(sample, Rejection::Operator, out);
    } else if (!used) {
      leave_out(sample, Rejection::Contradicted, out);
    } else {
      std::visit([&](const auto& is) { compute(is, out); }, used->is);
    }
    judge_answers(from, out);
  }
}

/// Replaces the orbit by the newest state.
void ThreeAxisPass::compute(const TimedOrbitState& state, ThreeAxisOutput& out) {
  const auto orbit = KeplerOrbit::through(state.t, state.state);
  if (!orbit) {
    leave_out({state.t, state}, Rejection::NoOrbit, out);
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
  const OrbitState at_earth{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const Eigen::Vector3d sun_icrf = sun_.direction_icrf(sun.t, spacecraft.value_or(at_earth));
  if (spacecraft && is_in_shadow(spacecraft->position_icrf_km, sun_icrf)) {
    leave_out({sun.t, sun}, Rejection::Shadow, out);
    return;
  }
  estimator_.push(SeenDirection{.t = sun.t,
                                .kind = SampleKind::Sun,
                                .direction = {.body = sun.sun_body,
                                              .ref = sun_icrf,
                                              .sigma_rad = config_.sun_sensor->noise_rad}},
                  out.products);
  if (!estimator_.has_repeated(SampleKind::Sun)) {
    gates_.see_sun(sun.t, sun.sun_body, sun_icrf, spacecraft);
  }
}

void ThreeAxisPass::compute(const MagneticField& field, ThreeAxisOutput& out) {
  const auto spacecraft = spacecraft_at(field.t);
  if (!spacecraft) {
    leave_out({field.t, field}, Rejection::NoOrbit, out);
    say_once({NoticeCode::FieldWithoutOrbit, {{"t_tai_ns", tai_ns(field.t)}}}, out);
    return;
  }
  const auto known_icrf_nt =
      field_ ? field_icrf_nt(*field_, field.t, spacecraft->position_icrf_km, earth_)
             : Unexpected{{ErrorCode::NoCoverage, {}}};
  if (!known_icrf_nt) {
    leave_out({field.t, field}, Rejection::NoField, out);
    say_once({NoticeCode::OutsideFieldModel, {{"t_tai_ns", tai_ns(field.t)}}}, out);
    return;
  }
  first_field_ = first_field_.value_or(field.t);
  last_field_ = field.t;
  const double noise_nt = config_.magnetometer->noise_nt;
  const double strength_nt = known_icrf_nt->norm();
  estimator_.push(SeenDirection{.t = field.t,
                                .kind = SampleKind::Magnetometer,
                                .direction = {.body = field.field_body_nt,
                                              .ref = *known_icrf_nt,
                                              .sigma_rad = noise_nt / strength_nt},
                                .stronger = (field.field_body_nt.norm() - strength_nt) / noise_nt},
                  out.products);
  if (!estimator_.has_repeated(SampleKind::Magnetometer)) {
    gates_.see_field(field.t, field.field_body_nt, *known_icrf_nt, spacecraft, out.products);
  }
}

void ThreeAxisPass::tell_of_mission(ThreeAxisOutput& out) const {
  if (estimator_.filter()) {
    out.products.emplace_back(normal_equations());
  }
}

NormalEquations ThreeAxisPass::normal_equations() const {
  std::vector<int> errors;
  const auto add = [&errors](bool has_sensor, int first, int count) {
    for (int i = first; has_sensor && i < first + count; ++i) {
      errors.push_back(i);
    }
  };
  add(config_.star_tracker.has_value(), StarTrackerError, 3);
  add(config_.sun_sensor.has_value(), SunSensorError, 3);
  add(config_.magnetometer.has_value(), MagnetometerError, 6);
  add(config_.gyro.has_value(), GyroScaleError, 9);
  add(config_.star_tracker.has_value(), StarTrackerTimeError, 1);
  add(config_.sun_sensor.has_value(), SunSensorTimeError, 1);
  add(config_.magnetometer.has_value(), MagnetometerTimeError, 1);

  const AlignmentEvidence nothing{FilterAlignment::Zero()};
  const auto& filter = estimator_.filter();
  const AlignmentEvidence& evidence = filter ? filter->evidence() : nothing;
  const double noise = estimator_.excess_noise();
  return named_equations(estimator_.given().value_or(TaiTime{}), errors,
                         evidence.information()(errors, errors) / noise,
                         evidence.score()(errors) / noise);
}

void ThreeAxisPass::leave_out(const OrderedSample& sample, Rejection rejected_by,
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

/// Doubts estimates after an orbit step if the field was compared on both sides of it. Such a step
/// does not matter for the direction to the Sun.
void ThreeAxisPass::doubt_where_orbit_steps(ThreeAxisOutput& out) {
  if (orbit_steps_.empty() || !first_field_) {
    return;
  }
  for (ThreeAxisProduct& product : out.products) {
    auto* const estimate = std::get_if<AttitudeEstimate>(&product);
    const auto step = estimate == nullptr ? std::nullopt
                                          : step_within(orbit_steps_, *first_field_,
                                                        std::min(*last_field_, estimate->t));
    if (step) {
      const Reason reason = reason_of(*step);
      say_once({NoticeCode::OrbitStepsInPass, reason.values}, out);
      doubt(estimate->assessment, reason);
    }
  }
}

void ThreeAxisPass::settle(ThreeAxisOutput& out) {
  const std::size_t from = out.products.size();
  estimator_.settle(out.products);
  judge_answers(from, out);
}

/// Shows the gates what the filter made of a sample, and advises where the body is lost. Samples
/// are judged one by one, so that it does not matter which of them came together.
/// @param from Number of products before the sample.
void ThreeAxisPass::judge_answers(std::size_t from, ThreeAxisOutput& out) {
  std::vector<ThreeAxisProduct> transitions;
  for (std::size_t i = from; i < out.products.size(); ++i) {
    const ThreeAxisProduct& product = out.products[i];
    if (const auto* const estimate = std::get_if<AttitudeEstimate>(&product)) {
      gates_.see(*estimate, spacecraft_at(estimate->t), transitions);
      advice_.see(*estimate);
    } else if (const auto* const seen = std::get_if<SampleObservation>(&product);
               seen != nullptr && seen->said.source == SampleSource::Magnetometer) {
      gates_.see_innovation(seen->said, transitions);
    }
  }
  std::ranges::move(transitions, std::back_inserter(out.products));
  if (auto advisory = advice_.advise(reached_, gates_, config_, sensors())) {
    out.products.emplace_back(*std::move(advisory));
  }
}

/// Gives a notice for each kind of which one test rejects nearly all samples.
void ThreeAxisPass::say_what_is_left_out(ThreeAxisOutput& out) {
  for (const ThreeAxisProduct& product : out.products) {
    const auto* const sample = std::get_if<RejectedSample>(&product);
    if (sample == nullptr || sample->rejected_by == Rejection::Operator) {
      continue;
    }
    const SensorHealth& sensor = sensors().at(index_of(sample->kind));
    std::int64_t& count = left_out_[{sample->kind, sample->rejected_by}];
    const double share =
        static_cast<double>(++count) / static_cast<double>(sensor.accepted + sensor.rejected);
    // Fewer rejections may be due to chance or to a passing cause.
    if (count >= 50 && share >= 0.9 &&
        said_left_out_.emplace(sample->kind, sample->rejected_by).second) {
      out.notices.push_back(most_left_out(*sample, 100.0 * share));
    }
  }
}

Notice ThreeAxisPass::most_left_out(const RejectedSample& last, double percent) const {
  Notice notice{NoticeCode::MostLeftOut,
                {{"sensor", std::string{name_of(last.kind)}},
                 {"percent", percent},
                 {"rejected_by", std::string{name_of(last.rejected_by)}}}};
  if (last.rejected_by == Rejection::Saturated) {
    notice.values.push_back({"rate_deg_s", degrees(last.failed.value().value)});
    notice.values.push_back({"range_deg_s", degrees(config_.gyro->range_rad_s.value())});
  }
  if (last.rejected_by == Rejection::Innovation) {
    notice.values.push_back({"sigmas", std::sqrt(last.failed.value().value)});
    notice.values.push_back({"most_sigmas", std::sqrt(last.failed.value().limit)});
  }
  return notice;
}

void ThreeAxisPass::say_once(Notice notice, ThreeAxisOutput& out) {
  if (said_.insert(notice.code).second) {
    out.notices.push_back(std::move(notice));
  }
}

}  // namespace spindrift
