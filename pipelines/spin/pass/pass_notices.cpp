#include "pipelines/spin/pass/pass_notices.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/measurement/edge_use.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/spin/types/spin_rate.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

// In short passes a large share of edges is left out before the spin period is found.
constexpr std::int64_t kFewestToJudge = 100;

/// Returns whether the edge, or its description in the mission file, is at fault.
bool is_of_the_edge(Rejection rejection) {
  return rejection != Rejection::Late && rejection != Rejection::OutOfTime &&
         rejection != Rejection::Copy && rejection != Rejection::Interference &&
         rejection != Rejection::Operator && rejection != Rejection::NoSensor &&
         rejection != Rejection::NoOrbit;
}

NamedValue at(TaiTime t) { return {"t_tai_ns", tai_ns(t)}; }

std::string text_of(PulseChannel channel) { return std::string{name_of(channel)}; }

}  // namespace

/// Says only the first notice of its kind.
void PassNotices::say_first(NoticeCode kind, Notice notice) {
  if (said_.insert(kind).second) {
    say(std::move(notice));
  }
}

void PassNotices::used(std::span<const SpinProduct> products) {
  for (const SpinProduct& product : products) {
    if (const auto* use = std::get_if<PulseUse>(&product)) {
      ++edges_;
      if (use->rejected_by) {
        ++left_out_[*use->rejected_by];
      }
    }
  }
}

void PassNotices::edge_came_late() { say_once({NoticeCode::LateEdges}); }

void PassNotices::edge_out_of_time() { say_once({NoticeCode::EdgesOutOfTime}); }

void PassNotices::associated(const Association& association) {
  left_over_any_ = left_over_any_ || !association.left_over.empty();
  closed_any_ = closed_any_ || !association.closed.empty();
  for (const CopiedEdge& copy : association.copies) {
    copied_channels_.insert(copy.pulse.channel);
    ++copies_;
    copies_apart_s_ += copy.apart_s;
    say_once(
        {NoticeCode::CopiesBegin, {at(copy.pulse.t), {"channel", text_of(copy.pulse.channel)}}});
  }
  for (const InterferingChannels& channels : association.began_to_interfere) {
    say({NoticeCode::InterferenceBegins,
         {at(channels.first),
          {"one", text_of(channels.one)},
          {"other", text_of(channels.other)},
          {"interference_s", config_.screening.interference_s}}});
  }
}

void PassNotices::counted_on(const Revolution& revolution) {
  if (const auto& off_turns = revolution.count_sigma_turns) {
    say({NoticeCode::CountUncertain, {{"turns", *off_turns}, {"revolution", revolution.number}}});
  }
}

void PassNotices::times_on_grid(TaiTime t, double width_s) {
  say_once({NoticeCode::TimesOnGrid, {at(t), {"grid_s", width_s}}});
}

void PassNotices::outside_orbit(TaiTime t, ErrorCode code) {
  ++outside_orbit_;
  last_outside_orbit_ = t;
  say_once({code == ErrorCode::NoCoverage ? NoticeCode::OutsideOrbit : NoticeCode::RangeImpossible,
            {at(t)}});
}

void PassNotices::without_fix(std::int64_t revolution, const WhyNoFix& why) {
  ++without_fix_;
  last_without_fix_ = why;
  if (revolution != cut_short_) {
    say_once({NoticeCode::NoFix, {{"revolution", revolution}}, why});
  }
}

void PassNotices::has_fix(const SpinFix& fix, std::optional<PriorVerdict> prior) {
  last_case_ = fix.geometry_case;
  prior_verdict_ = prior;
  if (fix.near_tangent) {
    ++near_tangent_;
  } else if (fix.resolution == Resolution::Ambiguous) {
    ++ambiguous_;
  } else if (!fix.accepted) {
    ++otherwise_not_accepted_;
  }
}

void PassNotices::settled_by_dispersion(TaiTime t, const StationaryBranch& branch) {
  const RaDec axis = ra_dec_of(branch.axis.axis_icrf);
  Notice notice{NoticeCode::DispersionSettles,
                {at(t),
                 {"ra_deg", degrees(axis.ra_rad)},
                 {"dec_deg", degrees(axis.dec_rad)},
                 {"fixes", branch.axis.count},
                 {"scatter_ratio", branch.scatter_ratio}}};
  if (const auto& ratio = branch.log_likelihood_ratio) {
    notice.code = NoticeCode::LikelihoodSettles;
    notice.values.push_back({"log_likelihood_ratio", *ratio});
  }
  say(std::move(notice));
}

void PassNotices::most_contradict_themselves() { say_once({NoticeCode::RevolutionsContradict}); }

void PassNotices::silent_where_it_must_see(Side side) {
  if (!std::exchange(silence_said_.at(index_of(side)), true)) {
    say({NoticeCode::HealthyBeamSilent, {{"beam", side == Side::North ? "north" : "south"}}});
  }
}

void PassNotices::fix_contradicts_itself() { say_once({NoticeCode::FixContradictsItself}); }

/// Notes that the axis chosen by the prior is not the one that the edges show.
void PassNotices::prior_contradicted(TaiTime t) {
  prior_contradicted_ = true;
  say_first(NoticeCode::PriorContradicted, {NoticeCode::PriorContradicted, {at(t), prior_from_}});
}

void PassNotices::root_far_from_all(TaiTime t, const Eigen::Vector3d& nearest_icrf,
                                    double apart_rad, double limit_rad) {
  const RaDec nearest = ra_dec_of(nearest_icrf);
  say_first(NoticeCode::RootFarFromAll, {NoticeCode::RootFarFromAll,
                                         {at(t),
                                          {"limit_deg", degrees(limit_rad)},
                                          {"ra_deg", degrees(nearest.ra_rad)},
                                          {"dec_deg", degrees(nearest.dec_rad)},
                                          {"deg", degrees(apart_rad)}}});
}

void PassNotices::root_chosen(TaiTime t, const Eigen::Vector3d& root_icrf, double apart_rad) {
  const RaDec root = ra_dec_of(root_icrf);
  say({NoticeCode::RootChosen,
       {at(t),
        {"ra_deg", degrees(root.ra_rad)},
        {"dec_deg", degrees(root.dec_rad)},
        {"deg", degrees(apart_rad)}}});
}

void PassNotices::prior_set(const SpinPrior& prior) {
  config_.prior = prior;
  prior_from_.value = "operator";
  prior_verdict_.reset();
  prior_contradicted_ = false;
  said_.erase(NoticeCode::PriorContradicted);
}

/// Compares every estimate with the prior, which may be wrong even if it chooses nothing.
void PassNotices::estimated(const SpinEstimate& estimate) {
  quality_ = estimate.assessment.quality;
  fixes_near_tangent_ = has(estimate.assessment, ReasonCode::FixesNearTangent);
  if (!config_.prior || !is_unopposed(*quality_)) {
    return;
  }
  const double apart_rad = angle_between_rad(config_.prior->axis_icrf, estimate.axis_icrf);
  const double sigma_rad =
      std::hypot(config_.prior->sigma_rad, std::sqrt(estimate.covariance_rad2.trace()));
  if (apart_rad > std::hypot(kContradictionSigmas * sigma_rad, kModelLimit_rad)) {
    say_first(NoticeCode::PriorContradicted, {NoticeCode::PriorFar,
                                              {at(estimate.t),
                                               {"deg", degrees(apart_rad)},
                                               {"sigmas", apart_rad / sigma_rad},
                                               prior_from_}});
  }
}

void PassNotices::axis_moved(TaiTime t, double apart_rad) {
  say({NoticeCode::AxisMoved, {at(t), {"deg", degrees(apart_rad)}}});
}

std::vector<std::string> PassNotices::channels_where(bool heard, bool described) const {
  std::vector<std::string> channels;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    if (heard_.at(i) == heard && has_sensor(config_, channel) == described) {
      channels.push_back(text_of(channel));
    }
  }
  return channels;
}

void PassNotices::pass_ended(std::span<const InterferingChannels> interfering,
                             const SequentialEstimator& sequential) {
  if (!closed_any_ && left_over_any_) {
    say({NoticeCode::NoPeriod,
         {{"slowest_rpm", kSlowestSearched_rpm}, {"fastest_rpm", kFastestSearched_rpm}}});
  }
  if (closed_any_) {
    say_what_was_copied();
    say_what_was_left_out();
  }
  if (auto silent = channels_where(false, true); closed_any_ && !silent.empty()) {
    say({NoticeCode::SilentChannels, {{"channels", std::move(silent)}}});
  }
  if (auto unknown = channels_where(true, false); !unknown.empty()) {
    say({NoticeCode::ChannelsWithoutSensor, {{"channels", std::move(unknown)}}});
  }
  for (const InterferingChannels& channels : interfering) {
    if (channels.revolutions < kFewestInterfering) {
      continue;
    }
    say({NoticeCode::Interfered,
         {{"one", text_of(channels.one)},
          {"other", text_of(channels.other)},
          {"revolutions", channels.revolutions},
          {"first_tai_ns", tai_ns(channels.first)},
          {"last_tai_ns", tai_ns(channels.last)}}});
  }
  if (outside_orbit_ > 1) {
    say({NoticeCode::MuchOutsideOrbit, {{"revolutions", outside_orbit_}, at(last_outside_orbit_)}});
  }
  say_what_the_axis_lacks(sequential);
}

void PassNotices::say_what_was_copied() {
  if (copies_ == 0) {
    return;
  }
  std::vector<std::string> channels;
  std::transform(copied_channels_.begin(), copied_channels_.end(), std::back_inserter(channels),
                 text_of);
  say({NoticeCode::Copied,
       {{"channels", std::move(channels)},
        {"edges", copies_},
        {"apart_s", copies_apart_s_ / static_cast<double>(copies_)}}});
}

void PassNotices::say_what_was_left_out() {
  std::erase_if(left_out_, [](const auto& of_kind) { return !is_of_the_edge(of_kind.first); });
  std::int64_t all = 0;
  for (const auto& [rejection, edges] : left_out_) {
    all += edges;
  }
  if (edges_ < kFewestToJudge || 2 * all <= edges_) {
    return;
  }
  const auto most =
      std::max_element(left_out_.begin(), left_out_.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  say({NoticeCode::EdgesLeftOut,
       {{"percent", 100.0 * static_cast<double>(all) / static_cast<double>(edges_)},
        {"most", std::string{name_of(most->first)}}}});
}

/// Explains a missing mean, which needs accepted fixes that are not near-tangent.
void PassNotices::say_why_no_mean() {
  if (mean_began_ || last_case_ == 0) {
    return;
  }
  say({NoticeCode::MeanNeverBegan,
       {{"fixes", near_tangent_ + ambiguous_ + otherwise_not_accepted_},
        {"near_tangent", near_tangent_},
        {"ambiguous", ambiguous_},
        {"not_accepted", otherwise_not_accepted_}}});
}

Notice PassNotices::why_ambiguous() const {
  using enum NoticeCode;
  const NamedValue of_case{"geometry_case", std::int64_t{last_case_}};
  if (fixes_near_tangent_) {
    return config_.prior ? Notice{AmbiguousPriorNoHelp, {of_case, prior_from_}}
                         : Notice{AmbiguousNearTangent, {of_case}};
  }
  if (!config_.prior) {
    return {AmbiguousNoPrior, {of_case}};
  }
  if (prior_contradicted_) {
    return {AmbiguousAgainstPrior, {of_case, prior_from_}};
  }
  if (prior_verdict_ == PriorVerdict::FarFromAll) {
    return {AmbiguousFarFromPrior, {of_case, prior_from_}};
  }
  if (prior_verdict_ == PriorVerdict::NearSeveral) {
    return {AmbiguousNearPrior,
            {of_case, prior_from_, {"prior_sigma_deg", degrees(config_.prior->sigma_rad)}}};
  }
  return {AmbiguousPriorNotBorne, {of_case, prior_from_}};
}

void PassNotices::say_what_the_axis_lacks(const SequentialEstimator& sequential) {
  if (!quality_ && last_case_ != 0) {
    say({NoticeCode::SequentialNeverBegan});
  }
  if (quality_ && is_unopposed(*quality_) && sequential.has_begun() &&
      sequential.model_leverage() > SequentialEstimator::kPoorLeverage) {
    const double error_deg = degrees(kModelError_rad);
    say({NoticeCode::LittleLeverage,
         {{"error_deg", error_deg}, {"moved_deg", sequential.model_leverage() * error_deg}}});
  }
  // A single revolution has its own notice, unless it was cut short.
  if (last_case_ == 0 && without_fix_ > (said_.contains(NoticeCode::NoFix) ? 1 : 0)) {
    say({NoticeCode::NoAxis, {{"revolutions", without_fix_}}, last_without_fix_});
  }
  say_why_no_mean();
  if (quality_ == Quality::Ambiguous) {
    say(why_ambiguous());
  }
}

}  // namespace spindrift
