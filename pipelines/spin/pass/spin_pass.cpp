#include "pipelines/spin/pass/spin_pass.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <span>
#include <utility>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/disambiguation/chosen_root.h"
#include "pipelines/spin/fix/axis_candidates.h"
#include "pipelines/spin/pass/revolution_products.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/statistics/median.h"
#include "pipelines/statistics/significance.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

bool is_doubted(const SpinEstimate& estimate) {
  return estimate.assessment.quality >= Quality::Doubtful;
}

// Number of fixes after which the mean axis counts for or against a candidate.
constexpr std::size_t kEstablishedFixes = 10;
// How far a candidate may be from where an operator points, beyond its own error.
constexpr double kMeant_rad = 5.0 * kRadPerDeg;

constexpr std::string_view kFrameKind = "coded_frame";

Eigen::Vector3d median_axis(const std::vector<Eigen::Vector3d>& axes) {
  Eigen::Vector3d median;
  for (Eigen::Index i = 0; i < 3; ++i) {
    std::vector<double> components(axes.size());
    std::transform(axes.begin(), axes.end(), components.begin(),
                   [i](const Eigen::Vector3d& axis) { return axis[i]; });
    median[i] = upper_median(components);
  }
  return median.normalized();
}

}  // namespace

SpinPass::SpinPass(const SpinConfig& config, Orbit orbit)
    : config_{config},
      told_prior_{config.prior},
      notices_{config},
      orbit_steps_{orbit_steps(orbit)},
      sun_earth_{std::move(orbit), config.horizon.co2_altitude_km},
      interference_{config.screening.interference_s},
      associator_{config},
      grid_{config.noise},
      screening_{config.screening},
      recent_axes_{static_cast<std::size_t>(config.screening.window)},
      disambiguator_{config},
      mean_{config},
      inconsistent_share_{static_cast<double>(config.screening.window)},
      sequential_{config} {}

SpinOutput SpinPass::push(const Pulse& pulse) {
  SpinOutput out;
  process(pulse, out);
  notices_.used(out.products);
  out.notices = notices_.take_pending();
  return out;
}

SpinOutput SpinPass::push(const CodedFrame& frame) {
  SpinOutput out;
  switch (frames_.offer(frame)) {
    case FrameReorderWindow::Verdict::Held:
      take_due(frames_.release(), out);
      break;
    case FrameReorderWindow::Verdict::Late:
      // Late frames are left out edge by edge.
      for (const Pulse& edge : edges_of(frame)) {
        process(edge, out);
      }
      break;
    case FrameReorderWindow::Verdict::OutOfTime:
      for (const Pulse& edge : edges_of(frame)) {
        leave_out_of_time(edge, out);
      }
      break;
    case FrameReorderWindow::Verdict::Duplicate:
      compare(frame, out);
      break;
  }
  notices_.used(out.products);
  out.notices = notices_.take_pending();
  return out;
}

void SpinPass::act(TaiTime t, const SpinAction& action) {
  std::visit(
      [&](const auto& what) {
        if constexpr (requires { excluded_.apply(t, what); }) {
          excluded_.apply(t, what);
        } else {
          to_do_.emplace(t, what);
        }
      },
      action);
}

SpinOutput SpinPass::fall_silent() {
  SpinOutput out;
  take_due(frames_.fall_silent(), out);
  sort_out(reorder_.fall_silent(), out);
  notices_.used(out.products);
  out.notices = notices_.take_pending();
  return out;
}

SpinOutput SpinPass::finish() {
  SpinOutput out;
  const FrameReorderWindow::Rest frames = frames_.release_all();
  take_due(frames.in_time, out);
  take_edges_before(TaiTime::max(), out);
  const ReorderWindow::Rest rest = reorder_.release_all();
  sort_out(rest.in_time, out);
  associate(interference_.finish(), out);
  Association last = associator_.finish();
  if (!last.closed.empty()) {
    notices_.cut_short(last.closed.back().number);
  }
  collect(std::move(last), out);
  if (!started_) {
    settle_first(out);
  }
  // Stray frames are not added to the edges again, where they would form a stream.
  for (const CodedFrame& frame : frames.out_of_time) {
    for (const Pulse& edge : edges_of(frame)) {
      leave_out_of_time(edge, out);
    }
  }
  for (const Pulse& pulse : rest.out_of_time) {
    leave_out_of_time(pulse, out);
  }
  if (auto choice = axis_choice()) {
    choice->shifts = shifts();
    out.products.emplace_back(*std::move(choice));
  }
  notices_.used(out.products);
  notices_.pass_ended(associator_.interfering(), sequential_);
  out.notices = notices_.take_pending();
  return out;
}

/// Reports a contradiction with a frame that has been computed, but does not recompute it.
void SpinPass::compare(const CodedFrame& again, SpinOutput& out) {
  const auto known = frames_.find(again);
  if (!known.released) {
    contested_.record(*known.sample, again);
  } else if (!say_the_same(*known.sample, again)) {
    out.products.emplace_back(SampleContradiction{
        .t = again.t, .kind = kFrameKind, .by = late_senders(*known.sample, again), .late = true});
  }
}

/// Leaves out all edges of frames that contradict each other, unless one of the frames counts.
void SpinPass::take_due(const std::vector<CodedFrame>& due, SpinOutput& out) {
  for (const CodedFrame& frame : due) {
    const std::vector<CodedFrame> said = contested_.release(frame);
    if (!is_contested(said)) {
      process(frame, out);
      continue;
    }
    const auto used = one_that_counts(said);
    out.products.emplace_back(
        SampleContradiction{.t = frame.t, .kind = kFrameKind, .by = senders_of(said, used)});
    if (used) {
      process(*used, out);
      continue;
    }
    std::set<Pulse> edges;
    for (const CodedFrame& one : said) {
      const std::vector<Pulse> of_one = edges_of(one);
      edges.insert(of_one.begin(), of_one.end());
    }
    for (const Pulse& edge : edges) {
      leave_out(edge, Rejection::Contradicted, out);
    }
  }
}

void SpinPass::process(const CodedFrame& frame, SpinOutput& out) {
  if (frame.period_s) {
    associator_.note_period(frame.t, *frame.period_s);
  }
  for (const Pulse& edge : edges_of(frame)) {
    of_next_frame_.insert(std::upper_bound(of_next_frame_.begin(), of_next_frame_.end(), edge),
                          edge);
  }
  take_edges_before(frame.period_s ? later_by_s(frame.t, *frame.period_s) : TaiTime::max(), out);
}

void SpinPass::take_edges_before(TaiTime t, SpinOutput& out) {
  auto edge = of_next_frame_.begin();
  for (; edge != of_next_frame_.end() && edge->t < t; ++edge) {
    process(*edge, out);
  }
  of_next_frame_.erase(of_next_frame_.begin(), edge);
}

void SpinPass::process(const Pulse& pulse, SpinOutput& out) {
  notices_.edge_came(pulse.channel);
  switch (reorder_.offer(pulse)) {
    case ReorderWindow::Verdict::Held:
      sort_out(reorder_.release(), out);
      break;
    case ReorderWindow::Verdict::Late:
      leave_out(pulse, Rejection::Late, out);
      notices_.edge_came_late();
      break;
    case ReorderWindow::Verdict::OutOfTime:
      leave_out_of_time(pulse, out);
      break;
    case ReorderWindow::Verdict::Duplicate:
      break;  // The use of an edge is reported only once.
  }
}

void SpinPass::leave_out(const Pulse& pulse, Rejection rejected_by, SpinOutput& out) {
  out.products.emplace_back(PulseUse{.pulse = pulse, .revolution = {}, .rejected_by = rejected_by});
}

void SpinPass::leave_out_of_time(const Pulse& pulse, SpinOutput& out) {
  leave_out(pulse, Rejection::OutOfTime, out);
  notices_.edge_out_of_time();
}

void SpinPass::sort_out(const std::vector<Pulse>& in_time, SpinOutput& out) {
  for (const Pulse& pulse : in_time) {
    if (excluded_.hold(pulse.t, pulse.channel)) {
      leave_out(pulse, Rejection::Operator, out);
    } else {
      associate(interference_.push(pulse), out);
    }
  }
}

void SpinPass::associate(const std::vector<InterferenceWindow::Judged>& pulses, SpinOutput& out) {
  for (const auto& [pulse, spoilt_by] : pulses) {
    collect(spoilt_by ? associator_.push_spoilt(pulse, *spoilt_by) : associator_.push(pulse), out);
  }
}

void SpinPass::collect(Association association, SpinOutput& out) {
  notices_.associated(association);
  std::move(association.left_over.begin(), association.left_over.end(),
            std::back_inserter(out.products));
  for (const Revolution& revolution : association.closed) {
    consider(revolution, out);
  }
}

/// Adds the time grid to the noise once it is known, which is before an answer can be OK.
void SpinPass::hear(const Revolution& revolution) {
  const auto sun1 = revolution.good_edge(PulseChannel::Sun1);
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    const auto t = revolution.good_edge(channel);
    // A chord end that the next sun1 interrupts may have been counted from that sun1.
    const bool of_next = sun1 && t && seconds_between(*sun1, *t) > revolution.period.period_s;
    if (t && !of_next) {
      grid_.learn({.t = *t, .channel = channel});
    }
  }
  if (grid_.width_s() != config_.noise.grid_s) {
    config_.noise.grid_s = grid_.width_s();
    sequential_.hear(config_.noise);
    notices_.times_on_grid(revolution.t_start, grid_.width_s());
  }
}

void SpinPass::consider(const Revolution& revolution, SpinOutput& out) {
  notices_.counted_on(revolution);
  hear(revolution);
  compare_sensors(revolution, out);
  Candidate candidate{.revolution = revolution,
                      .measured = measure(config_, revolution),
                      .sun_earth = {},
                      .residuals = {}};
  expect_no_silence(candidate);
  if (const auto sun_earth = sun_earth_.sun_earth(candidate.measured, revolution.t_start)) {
    candidate.sun_earth = *sun_earth;
  } else {
    notices_.outside_orbit(revolution.t_start, sun_earth.error().code);
  }
  if (!started_) {
    first_.push_back(std::move(candidate));
    if (first_.size() >= kFirstRevolutions) {
      settle_first(out);
    }
    return;
  }
  if (predicted_from_) {
    predict(candidate, predicted_from_->axis_icrf);
  }
  screen(candidate);
  settle(candidate, out);
  recent_.push_back(std::move(candidate));
  if (recent_.size() > static_cast<std::size_t>(config_.screening.window)) {
    recent_.pop_front();
  }
  predict_anew_where_better_known();
}

/// Compares the sensors where an answer is missing or opposed, and until they agree again.
void SpinPass::compare_sensors(const Revolution& revolution, SpinOutput& out) {
  const auto block = blocks_.add(config_.noise, revolution);
  if (!block) {
    return;
  }
  const auto sky = sun_earth_.sky(block->t);
  if (!sky) {
    return;
  }
  contradictions_.add({.block = *block, .sky = *sky});
  const bool is_answered = answer_ && is_unopposed(answer_->assessment.quality);
  if (!is_answered || contradictions_.is_due()) {
    contradictions_.compare(config_, axes_to_try_icrf());
  }
  out.products.emplace_back(
      SensorsCompared{.t = revolution.t_start, .contradiction = contradictions_.found()});
}

std::vector<Eigen::Vector3d> SpinPass::axes_to_try_icrf() const {
  std::vector<Eigen::Vector3d> axes_icrf;
  if (answer_) {
    axes_icrf.push_back(answer_->axis_icrf);
    if (const auto other = other_axis_icrf(answer_->axis_icrf)) {
      axes_icrf.push_back(*other);
    }
  } else if (config_.prior) {
    axes_icrf.push_back(config_.prior->axis_icrf);
  }
  return axes_icrf;
}

void SpinPass::doubt_where_sensors_contradict(SpinEstimate& estimate) const {
  if (const auto& found = contradictions_.found()) {
    doubt(estimate.assessment, reason_of(*found));
  }
}

/// Ignores the silence of a beam that an operator has excluded.
void SpinPass::expect_no_silence(Candidate& candidate) const {
  for (const Side side : kSides) {
    const TaiTime t = candidate.revolution.t_start;
    if (excluded_.hold(t, kInChannels.at(index_of(side))) ||
        excluded_.hold(t, kOutChannels.at(index_of(side)))) {
      candidate.measured.silent.at(index_of(side)) = false;
    }
  }
}

void SpinPass::settle_first(SpinOutput& out) {
  started_ = true;
  std::vector<Eigen::Vector3d> axes_icrf;
  for (const Candidate& candidate : first_) {
    if (!candidate.sun_earth) {
      continue;
    }
    const auto found = axis_candidates(config_, candidate.measured, *candidate.sun_earth);
    if (found && found->told_apart) {
      axes_icrf.push_back(found->candidates.front().axis_icrf);
    }
  }
  if (!axes_icrf.empty()) {
    const Eigen::Vector3d axis_icrf = median_axis(axes_icrf);
    for (Candidate& candidate : first_) {
      predict(candidate, axis_icrf);
    }
  }
  // All revolutions are counted first, so that they all judge the first one.
  for (Candidate& candidate : first_) {
    screen(candidate);
    if (candidate.sun_earth) {
      count_consistency(axis_candidates(config_, candidate.measured, *candidate.sun_earth),
                        candidate);
    }
  }
  for (Candidate& candidate : first_) {
    settle(candidate, out);
  }
  recent_.assign(std::make_move_iterator(first_.begin()), std::make_move_iterator(first_.end()));
  first_.clear();
  predict_anew_where_better_known();
}

/// Predicts all residuals anew when the mean has twice as many fixes, since they are comparable
/// only against one axis.
void SpinPass::predict_anew_where_better_known() {
  const auto axis_icrf = recent_axes_.axis_icrf();
  if (!axis_icrf || (predicted_from_ && mean_.count() < 2 * predicted_from_->fixes)) {
    return;
  }
  predicted_from_ = {.axis_icrf = *axis_icrf, .fixes = mean_.count()};
  screening_ = ScreeningWindow{config_.screening};
  for (Candidate& candidate : recent_) {
    predict(candidate, *axis_icrf);
  }
}

void SpinPass::predict(Candidate& candidate, const Eigen::Vector3d& axis_icrf) {
  if (candidate.sun_earth) {
    candidate.residuals = residuals(config_, candidate.measured, *candidate.sun_earth, axis_icrf);
    for (const AngleResidual& residual : candidate.residuals) {
      screening_.add(residual);
    }
  }
}

void SpinPass::screen(Candidate& candidate) const {
  for (const AngleResidual& residual : candidate.residuals) {
    if (const auto said = screening_.judged(candidate.revolution.t_start, residual)) {
      judge(candidate.measured, residual.quantity, *said);
    } else {
      reject(candidate.measured, residual.quantity, rejection_of(residual.quantity));
    }
  }
  if (!candidate.sun_earth) {
    for (const SpinQuantity quantity : kMeasuredAngles) {
      reject(candidate.measured, quantity, Rejection::NoOrbit);
    }
  }
}

void SpinPass::settle(Candidate& candidate, SpinOutput& out) {
  const std::size_t first = out.products.size();
  auto products = revolution_products(config_, candidate.revolution, candidate.measured);
  std::move(products.begin(), products.end(), std::back_inserter(out.products));
  if (candidate.sun_earth) {
    announce_axis(candidate, out);
    note_observations(std::span{out.products}.subspan(first));
  }
}

/// Adds the observation of the filter to the use of each edge.
void SpinPass::note_observations(std::span<SpinProduct> products) const {
  for (SpinProduct& product : products) {
    auto* const use = std::get_if<PulseUse>(&product);
    if (use == nullptr) {
      continue;
    }
    for (const Observation& said : sequential_.observations()) {
      if (said.t == use->pulse.t && said.source == source_of(use->pulse.channel)) {
        use->said = said;
      }
    }
  }
}

/// Counts contradicting revolutions: with a wrong mission file or orbit most contradict themselves,
/// and the rest agree by accident or have too few measurements.
void SpinPass::count_consistency(const FoundCandidates& found, Candidate& candidate) {
  const bool contradicts = is_inconsistent(found);
  if (!std::exchange(candidate.is_counted, true) && (found || contradicts)) {
    inconsistent_share_.add(contradicts ? 1.0 : 0.0);
  }
}

bool SpinPass::most_are_consistent() const { return inconsistent_share_.mean() < 0.5; }

std::vector<SpinFix> SpinPass::find_fixes(Candidate& candidate) {
  const Revolution& revolution = candidate.revolution;
  const auto found = axis_candidates(config_, candidate.measured, *candidate.sun_earth);
  count_consistency(found, candidate);
  if (!found) {
    // The measurements stay valid; only the axis is missing.
    notices_.without_fix(revolution.number, found.error().why);
    return {};
  }
  choose_root(revolution.t_start, *found);
  auto fixes = disambiguator_.settle(revolution.number, revolution.t_start, candidate.measured,
                                     *candidate.sun_earth, *found, established_axis());
  for (SpinFix& fix : fixes) {
    fix.accepted = fix.accepted && most_are_consistent();
  }
  if (const auto& steady = disambiguator_.newly_stationary()) {
    notices_.settled_by_dispersion(revolution.t_start, *steady);
  }
  notices_.has_fix(fixes.back(), disambiguator_.prior_verdict());
  return fixes;
}

void SpinPass::say_why_not_accepted(const SpinFix& fix) {
  if (!most_are_consistent()) {
    notices_.most_contradict_themselves();
  } else if (const auto side = disambiguator_.silent_despite_view()) {
    notices_.silent_where_it_must_see(*side);
  } else if (!fix.accepted && fix.resolution != Resolution::Ambiguous) {
    notices_.fix_contradicts_itself();
  }
}

void SpinPass::announce_axis(Candidate& candidate, SpinOutput& out) {
  const Revolution& revolution = candidate.revolution;
  const bool had_mean = mean_.count() > 0;
  first_axis_ = first_axis_.value_or(revolution.t_start);
  on_orbit_since_ = on_orbit_since_.value_or(revolution.t_start);
  do_what_is_due(revolution.t_start);
  const std::vector<SpinFix> fixes = find_fixes(candidate);
  std::optional<SpinEstimate> sequential;
  if (const auto sky = sun_earth_.sky(revolution.t_start)) {
    sequential = sequential_.update(
        revolution, *sky, most_are_consistent() ? std::span{fixes} : std::span<const SpinFix>{});
    if (sequential_.prior_refuted() && config_.prior) {
      forget_prior(revolution.t_start);
    }
    if (sequential && (sequential_.restarts() > restarts_handled_ ||
                       recent_fixes_left_the_mean_for(sequential->axis_icrf))) {
      start_again_where_moved(*sequential);
    }
  }
  std::copy(fixes.begin(), fixes.end(), std::back_inserter(out.products));
  const bool mean_given_up = had_mean && mean_.count() == 0;
  bool mean_moved = false;
  mean_.keep(revolution.number, candidate.measured, *candidate.sun_earth);
  for (const SpinFix& fix : fixes) {
    note_choice(fix);
    say_why_not_accepted(fix);
    if (mean_.add_fix(fix)) {
      recent_axes_.add_fix(fix);
      mean_moved = true;
    }
  }
  const auto doubt_copies = [this](Assessment& assessment) {
    if (associator_.noise_chose_among_copies()) {
      doubt(assessment, {ReasonCode::CopiesInNoise});
    }
  };
  // An axis that has moved shows in the mean last, since most of its fixes are from before.
  const bool doubted = sequential && is_doubted(*sequential);
  const bool doubt_begins = doubted && mean_.count() > 0 && answer_ && !is_doubted(*answer_);
  if (mean_moved || mean_given_up || doubt_begins) {
    SpinEstimate mean = mean_.estimate(revolution);
    doubt_copies(mean.assessment);
    doubt_where_orbit_steps(mean);
    doubt_where_sensors_contradict(mean);
    if (doubted && is_unopposed(mean.assessment.quality)) {
      doubt(mean.assessment, sequential->assessment.reasons.front());
    }
    if (!sequential_.has_begun()) {
      answer_ = mean;
    }
    out.products.emplace_back(std::move(mean));
    notices_.mean_began();
  }
  if (sequential) {
    doubt_copies(sequential->assessment);
    doubt_where_orbit_steps(*sequential);
    doubt_where_sensors_contradict(*sequential);
    notices_.estimated(*sequential);
    answer_ = *sequential;
    out.products.emplace_back(std::move(*sequential));
  }
}

/// Notes the choice of a fix; a fix that is settled again replaces its earlier version.
void SpinPass::note_choice(const SpinFix& fix) {
  if (fix.accepted && !fix.settled_before &&
      (!settling_fix_ || fix.revolution <= settling_fix_->revolution)) {
    settling_fix_ = fix;
  }
  if (!fix.alternates.empty()) {
    const auto best = std::min_element(
        fix.alternates.begin(), fix.alternates.end(),
        [](const SpinAlternate& a, const SpinAlternate& b) { return a.misfit < b.misfit; });
    alternate_icrf_ = best->axis_icrf;
  }
}

/// Returns the rival of `sequential`, else the best alternate of the last fix. Without either it is
/// the mirror image in the plane of Sun and Earth, which sees both at the same angles.
std::optional<Eigen::Vector3d> SpinPass::other_axis_icrf(const Eigen::Vector3d& axis_icrf) const {
  if (const auto rival = sequential_.rival()) {
    return rival->axis_icrf;
  }
  const auto last = std::find_if(recent_.rbegin(), recent_.rend(), [](const Candidate& candidate) {
    return candidate.sun_earth.has_value();
  });
  if (alternate_icrf_ || last == recent_.rend()) {
    return alternate_icrf_;
  }
  const Eigen::Vector3d across =
      last->sun_earth->sun_icrf.cross(last->sun_earth->earth_icrf).normalized();
  return Eigen::Vector3d{axis_icrf - 2.0 * axis_icrf.dot(across) * across};
}

std::optional<AxisChoice> SpinPass::axis_choice() const {
  if (!answer_) {
    return std::nullopt;
  }
  const Resolution by_fix = settling_fix_ ? settling_fix_->resolution : Resolution::Ambiguous;
  return AxisChoice{
      .t = answer_->t,
      .estimator = answer_->estimator,
      .axis_icrf = answer_->axis_icrf,
      .other_icrf = other_axis_icrf(answer_->axis_icrf),
      .delta_chi_square = {},
      .settled_by = sequential_.settled_by_edges() ? SettledBy::Edges : settled_by(by_fix)};
}

/// Returns the shifts of the last answers; `mean` has none as a plain average.
std::vector<EstimatorShift> SpinPass::shifts() const {
  std::vector<EstimatorShift> all;
  if (const auto of_mean = mean_.shift_icrf()) {
    all.push_back({.estimator = SpinEstimator::Mean, .shift_icrf = *of_mean});
  }
  if (sequential_.has_begun()) {
    all.push_back({.estimator = SpinEstimator::Sequential, .shift_icrf = sequential_.shift_icrf()});
  }
  return all;
}

void SpinPass::doubt_where_orbit_steps(SpinEstimate& estimate) {
  if (const auto step = step_within(orbit_steps_, *on_orbit_since_, estimate.t)) {
    const Reason reason = reason_of(*step);
    notices_.orbit_steps({NoticeCode::OrbitStepsInPass, reason.values});
    doubt(estimate.assessment, reason);
  }
}

void SpinPass::do_what_is_due(TaiTime t) {
  const auto later = to_do_.upper_bound(t);
  for (auto due = to_do_.begin(); due != later; due = to_do_.erase(due)) {
    std::visit([&](const auto& action) { apply(t, action); }, due->second);
  }
}

void SpinPass::apply(TaiTime /*t*/, const ChooseRoot& action) {
  root_to_choose_ = action;
  notices_.root_to_choose();
}

/// Returns the axes among which an operator chooses: those that `sequential` follows, which its
/// estimate names. Those of a fix that noise does not scatter, while it follows only one.
std::vector<StartingPoint> SpinPass::roots_of(const AxisCandidates& found) const {
  std::vector<StartingPoint> roots = sequential_.followed();
  if (roots.size() > 1 || found.near_tangent) {
    return roots;
  }
  roots.clear();
  for (const AxisCandidate& root : found.candidates) {
    roots.push_back({.axis_icrf = root.axis_icrf, .covariance_rad2 = root.total_covariance_rad2()});
  }
  return roots;
}

/// Sets a prior at the chosen root, with a third of the distance to the next one as sigma. Roots
/// that noise does not separate are no choice, and none that is far off is meant.
void SpinPass::choose_root(TaiTime t, const AxisCandidates& found) {
  if (!root_to_choose_ || found.told_apart) {
    return;
  }
  std::vector<StartingPoint> roots = roots_of(found);
  if (roots.size() < 2) {
    return;
  }
  const auto chosen = std::min_element(
      roots.begin(), roots.end(),
      [&wanted = root_to_choose_->axis_icrf](const StartingPoint& a, const StartingPoint& b) {
        return angle_between_rad(wanted, a.axis_icrf) < angle_between_rad(wanted, b.axis_icrf);
      });
  const StartingPoint root = *chosen;
  const double sigma_rad = std::sqrt(root.covariance_rad2.trace());
  const double apart_rad = angle_between_rad(root.axis_icrf, root_to_choose_->axis_icrf);
  if (apart_rad > kMeant_rad + kPriorSigmas * sigma_rad) {
    notices_.root_far_from_all(t, root.axis_icrf, apart_rad, kMeant_rad);
    return;
  }
  roots.erase(chosen);
  std::vector<Eigen::Vector3d> others_icrf;
  for (const StartingPoint& other : roots) {
    others_icrf.push_back(other.axis_icrf);
  }
  const SpinPrior prior = prior_choosing(root.axis_icrf, others_icrf);
  if (prior.sigma_rad > sigma_rad) {
    notices_.root_chosen(t, root.axis_icrf, apart_rad);
    apply(t, SetPrior{prior});
  }
}

/// Sets the prior. Earlier results stand unless they contradict it.
void SpinPass::apply(TaiTime t, const SetPrior& action) {
  const SpinPrior& prior = action.prior;
  const auto shown = established_axis();
  const bool contradicted =
      sequential_.prior_refuted() ||
      (shown && angle_between_rad(shown->axis_icrf, prior.axis_icrf) >
                    kContradictionSigmas * std::hypot(shown->sigma_rad, prior.sigma_rad));
  config_.prior = told_prior_ = prior;
  sequential_.expect(prior);
  notices_.prior_set(prior);
  root_to_choose_.reset();
  if (contradicted) {
    apply(t, MarkManoeuvre{});
  } else {
    disambiguator_ = Disambiguator{config_};
  }
}

void SpinPass::apply(TaiTime t, const MarkManoeuvre& /*action*/) {
  if (t == first_axis_) {
    return;
  }
  begin_anew(t);
  on_orbit_since_ = t;
  sequential_ = SequentialEstimator{config_};
  restarts_handled_ = 0;
  blocks_ = {};
  contradictions_ = {};
}

void SpinPass::forget_prior(TaiTime t) {
  config_.prior.reset();
  begin_anew(t);
  notices_.prior_contradicted(t);
}

void SpinPass::begin_anew(TaiTime t) {
  settling_fix_.reset();
  alternate_icrf_.reset();
  mean_.begin_anew(t);
  recent_axes_ = AxisWindow{static_cast<std::size_t>(config_.screening.window)};
  screening_ = ScreeningWindow{config_.screening};
  predicted_from_.reset();
  recent_.clear();
  disambiguator_ = Disambiguator{config_};
}

/// Compares the recent fixes with the mean; they share model errors, so a difference is the axis's.
bool SpinPass::recent_fixes_left_the_mean_for(const Eigen::Vector3d& axis_icrf) const {
  const auto recent_icrf = recent_axes_.axis_icrf();
  if (!recent_icrf || mean_.count() == 0) {
    return false;
  }
  const double apart_rad = angle_between_rad(*recent_icrf, mean_.axis_icrf());
  return apart_rad > kModelLimit_rad && angle_between_rad(*recent_icrf, axis_icrf) < apart_rad;
}

/// Starts the mean again if `sequential` clearly has another axis. After a restart or deviating
/// fixes this may take some revolutions, until its axis is known well.
void SpinPass::start_again_where_moved(const SpinEstimate& sequential) {
  if (mean_.count() == 0) {
    return;
  }
  const double apart_rad = angle_between_rad(mean_.axis_icrf(), sequential.axis_icrf);
  // Errors of the mission file move both axes, and alike as far as both rest on the same angles.
  const auto of_mean = mean_.shift_icrf();
  const double alignment_rad = of_mean ? (*of_mean - sequential_.shift_icrf()).norm()
                                       : std::sqrt(mean_.alignment_rad2().trace()) +
                                             std::sqrt(sequential.alignment_rad2.trace());
  const double sigma_rad =
      std::sqrt(mean_.covariance_if_moved_rad2().trace() +
                std::pow(noise_sigma_rad(sequential), 2) + alignment_rad * alignment_rad);
  if (apart_rad <= std::hypot(kContradictionSigmas * sigma_rad, kModelLimit_rad)) {
    return;
  }
  restarts_handled_ = sequential_.restarts();
  begin_anew(sequential.t);
  notices_.axis_moved(sequential.t, apart_rad);
}

/// Returns the axis of the mean, or the one that the edges settled if that is better known.
std::optional<KnownAxis> SpinPass::established_axis() const {
  std::optional<KnownAxis> by_edges = sequential_.settled_by_edges();
  if (mean_.count() < kEstablishedFixes) {
    return by_edges;
  }
  const KnownAxis by_mean{
      .axis_icrf = mean_.axis_icrf(),
      .sigma_rad = std::hypot(std::sqrt(mean_.covariance_rad2().trace()), kModelLimit_rad),
      .settled_by = settling_fix_ ? settling_fix_->resolution : Resolution::Dispersion};
  return by_edges && by_edges->sigma_rad < by_mean.sigma_rad ? by_edges : by_mean;
}

}  // namespace spindrift
