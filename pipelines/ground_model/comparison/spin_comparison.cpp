#include "pipelines/ground_model/comparison/spin_comparison.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

constexpr double kDegPerTurn = 360.0;
constexpr std::size_t kPeriod = 0;  ///< Index of the channel `period`.
/// An edge of sun1 is missing where the last is more than this many turns old.
constexpr double kMissing_turns = 1.5;

double square(double value) { return value * value; }

/// Sorts the edges of a pass into revolutions.
class Revolutions {
 public:
  explicit Revolutions(const SpinMotion& motion) : motion_{motion} {}

  void add_edge(const TrueEdge& edge) {
    if (edge.channel == PulseChannel::Sun1) {
      close(edge.t_s);
      open_ = ModelRevolution{.t_s = edge.t_s, .period_s = 0.0, .turns = {}};
    } else if (open_) {
      auto& behind_s = open_->turns.at(index_of(edge.channel));
      behind_s = behind_s.value_or(edge.t_s - open_->t_s);
    }
  }

  std::vector<ModelRevolution> all() && { return std::move(all_); }

 private:
  /// Keeps the open revolution unless the edge of sun1 that should end it is missing.
  void close(double end_s) {
    if (!open_) {
      return;
    }
    open_->period_s = end_s - open_->t_s;
    if (open_->period_s > kMissing_turns * kTurn_rad / motion_.rate_at_rad_s(open_->t_s)) {
      return;
    }
    for (auto& turns : open_->turns) {
      if (turns) {
        *turns /= open_->period_s;
      }
    }
    all_.push_back(*open_);
  }

  const SpinMotion& motion_;
  std::optional<ModelRevolution> open_;
  std::vector<ModelRevolution> all_;
};

template <class Sample>
std::vector<Sample> rest_of(BasicReorderWindow<Sample>& window) {
  return window.release_all().in_time;
}

}  // namespace

Expected<SpinModel> spin_model(const SpinTruth& truth, const PulseLink& link, double resolution_s,
                               const Orbit& orbit, double duration_s) {
  if (!(link.noise.sun_s > 0.0 && link.noise.infrared_s > 0.0)) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       "the model has no noise by which flight could be judged: the true noise of "
                       "sun and infrared pulses must be above 0"}};
  }
  SpinEdges source{truth, orbit};
  return source.until(duration_s)
      .and_then([&](const std::vector<TrueEdge>& edges) -> Expected<SpinModel> {
        Revolutions revolutions{truth.motion};
        for (const TrueEdge& edge : edges) {
          if (!link.channels.at(index_of(edge.channel)).dead) {
            revolutions.add_edge(edge);
          }
        }
        SpinModel model{.start = truth.start,
                        .noise = link.noise,
                        .resolution_s = resolution_s,
                        .revolutions = std::move(revolutions).all()};
        if (model.revolutions.empty()) {
          return Unexpected{{ErrorCode::InvalidConfiguration,
                             "the model has no revolution: its sun1 sees no Sun, or is dead"}};
        }
        return model;
      });
}

SpinComparison::SpinComparison(const SpinModel& model) : model_{&model} {
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    const bool is_seen = std::any_of(
        model.revolutions.begin(), model.revolutions.end(),
        [i](const ModelRevolution& revolution) { return revolution.turns.at(i).has_value(); });
    if (channel == PulseChannel::Sun1 || is_seen) {
      compared_.push_back(channel);
      channel_of_.at(i) = kPeriod + compared_.size();
    }
  }
}

std::vector<ComparedChannel> SpinComparison::channels() const {
  const double held_s = holding_s(model_->revolutions.front().period_s);
  std::vector<ComparedChannel> all = {{.name = "period", .unit = "s", .holding_s = held_s}};
  for (const PulseChannel channel : compared_) {
    all.push_back({.name = std::string{name_of(channel)},
                   .unit = channel == PulseChannel::Sun1 ? "" : "deg",
                   .holding_s = held_s});
  }
  return all;
}

std::vector<ComparedSample> SpinComparison::compare(const Pulse& pulse) {
  Samples all;
  if (!is_coded_.value_or(false)) {
    is_coded_ = false;
    pulses_.offer(pulse);
    for (const Pulse& next : pulses_.release()) {
      see_in_order(next, all);
    }
  }
  return all;
}

std::vector<ComparedSample> SpinComparison::compare(const CodedFrame& frame) {
  Samples all;
  if (is_coded_.value_or(true)) {
    is_coded_ = true;
    frames_.offer(frame);
    for (const CodedFrame& next : frames_.release()) {
      see_in_order(next, all);
    }
  }
  return all;
}

std::vector<ComparedSample> SpinComparison::finish() {
  Samples all;
  for (const Pulse& pulse : rest_of(pulses_)) {
    see_in_order(pulse, all);
  }
  for (const CodedFrame& frame : rest_of(frames_)) {
    see_in_order(frame, all);
  }
  return all;
}

void SpinComparison::see_in_order(const Pulse& pulse, Samples& all) {
  if (pulse.channel == PulseChannel::Sun1) {
    begin({.t = pulse.t, .edges = {}}, all);
    return;
  }
  note_missing_sun(pulse.t, all);
  if (open_) {
    open_->edges.push_back(pulse);
  }
}

/// Edges that `edges_of` puts after the next sun1 are still counted with this revolution.
void SpinComparison::see_in_order(const CodedFrame& frame, Samples& all) {
  std::vector<Pulse> edges = edges_of(frame);
  std::erase_if(edges, [](const Pulse& edge) { return edge.channel == PulseChannel::Sun1; });
  begin({.t = frame.t, .edges = std::move(edges)}, all);
}

void SpinComparison::begin(Revolution next, Samples& all) {
  if (open_) {
    compare(*open_, next.t, all);
  }
  open_ = std::move(next);
}

void SpinComparison::compare(const Revolution& revolution, TaiTime end, Samples& all) {
  const auto place = place_near(revolution.t);
  const double period_s = elapsed_s(revolution.t, end);
  if (!place || !(period_s > 0.0)) {
    return;
  }
  const ModelRevolution& model = model_->revolutions[*place];
  const bool is_whole = period_s <= kMissing_turns * model.period_s;
  all.push_back({.channel = *channel_of_.front(), .t = end, .came = is_whole});
  if (!is_whole) {
    return;
  }
  std::array<bool, kPulseChannels> came{};
  for (const Pulse& edge : revolution.edges) {
    const auto& channel = channel_of_.at(index_of(edge.channel));
    const auto turns = turns_at(*place, edge.channel);
    came.at(index_of(edge.channel)) = true;
    if (channel && turns) {
      all.push_back({.channel = *channel,
                     .t = edge.t,
                     .came = true,
                     .value = phase(edge.channel, elapsed_s(revolution.t, edge.t) / period_s,
                                    *turns, period_s)});
    }
  }
  for (const PulseChannel channel : compared_) {
    if (model.turns.at(index_of(channel)) && !came.at(index_of(channel))) {
      all.push_back({.channel = *channel_of_.at(index_of(channel)), .t = end, .came = false});
    }
  }
  all.push_back({.channel = kPeriod,
                 .t = end,
                 .came = true,
                 .value = ComparedValue{.flight = period_s,
                                        .model = model.period_s,
                                        .sigma = std::sqrt(2.0) * model_->noise.sun_s}});
}

/// Adds a missing edge of sun1 where other edges come and sun1 is overdue.
void SpinComparison::note_missing_sun(TaiTime t, Samples& all) {
  if (!open_ && !first_) {
    first_ = t;
  }
  const double since_s = elapsed_s(open_ ? open_->t : *first_, t);
  const auto place = place_near(t);
  if (place && since_s > kMissing_turns * model_->revolutions[*place].period_s) {
    all.push_back({.channel = *channel_of_.front(), .t = t, .came = false});
  }
}

/// Returns the index of the model's revolution that begins nearest to `t`; empty beyond a period.
std::optional<std::size_t> SpinComparison::place_near(TaiTime t) const {
  const std::vector<ModelRevolution>& all = model_->revolutions;
  const double t_s = elapsed_s(model_->start, t);
  auto near = std::lower_bound(
      all.begin(), all.end(), t_s,
      [](const ModelRevolution& revolution, double at_s) { return revolution.t_s < at_s; });
  if (near == all.end() || (near != all.begin() && t_s - std::prev(near)->t_s < near->t_s - t_s)) {
    --near;
  }
  return std::abs(near->t_s - t_s) <= near->period_s
             ? std::optional{static_cast<std::size_t>(near - all.begin())}
             : std::nullopt;
}

/// Falls back to the neighbouring revolutions: an edge near that of sun1 may fall into either.
std::optional<double> SpinComparison::turns_at(std::size_t place, PulseChannel channel) const {
  const std::vector<ModelRevolution>& all = model_->revolutions;
  const std::size_t i = index_of(channel);
  for (const std::size_t at : {place, place + 1, place - 1}) {
    if (at < all.size() && all[at].turns.at(i)) {
      return all[at].turns.at(i);
    }
  }
  return std::nullopt;
}

/// Returns the phases of an edge; their sigma includes the noise of both edges of sun1.
ComparedValue SpinComparison::phase(PulseChannel channel, double turns, double model_turns,
                                    double period_s) const {
  const double share = turns - std::floor(turns);
  const double away = turns - model_turns;
  double variance_s2 = square(edge_sigma_s(model_->noise, channel)) +
                       square(model_->noise.sun_s) * (square(1.0 - share) + square(share));
  if (is_coded_.value_or(false)) {
    variance_s2 += square(model_->resolution_s) / 12.0;
  }
  return {.flight = kDegPerTurn * (model_turns + away - std::round(away)),
          .model = kDegPerTurn * model_turns,
          .sigma = kDegPerTurn * std::sqrt(variance_s2) / period_s};
}

}  // namespace spindrift
