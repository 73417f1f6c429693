#include "pipelines/spin/association/copies.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "pipelines/statistics/median.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

constexpr std::size_t kLast = 10;
// Copies stay usual with at least this many: two receivers that lose half still give a third twice.
constexpr std::ptrdiff_t kFewestToStay = 2;
constexpr std::size_t kMostBehind = 100;
constexpr std::size_t kFewestBehind = 30;

bool are_most(const std::deque<bool>& had_copies) {
  const auto with = std::count(had_copies.begin(), had_copies.end(), true);
  // Copies become usual with at least this many revolutions: one edge in twenty may come doubled.
  return with >= 3 && 2 * with > std::ssize(had_copies);
}

double quantile(const std::deque<double>& values, double share) {
  std::vector<double> reordered{values.begin(), values.end()};
  const double place = share * static_cast<double>(values.size() - 1);
  return in_order_at(reordered, static_cast<std::size_t>(place));
}

}  // namespace

std::optional<double> Copies::behind_first_s(const Pulse& pulse, double period_s) {
  Channel& own = channels_.at(index_of(pulse.channel));
  const double behind_s = elapsed_s(own.first, pulse.t);
  if (!own.had_copies.empty() && behind_s > 0.0 && behind_s <= kCopies_turns * period_s) {
    if (!std::exchange(own.had_copies.back(), true)) {
      own.behind_s.push_back(behind_s);
    }
    if (own.behind_s.size() > kMostBehind) {
      own.behind_s.pop_front();
    }
    own.are_usual = own.are_usual || are_most(own.had_copies);
    return are_usual(pulse.channel) ? std::optional{behind_s} : std::nullopt;
  }
  own.first = pulse.t;
  own.had_copies.push_back(false);
  if (own.had_copies.size() > kLast) {
    own.had_copies.pop_front();
  }
  const auto with = std::count(own.had_copies.begin(), own.had_copies.end(), true);
  own.are_usual = own.are_usual && with >= kFewestToStay;
  return std::nullopt;
}

bool Copies::are_usual(PulseChannel channel) const {
  const auto heard = std::count_if(channels_.begin(), channels_.end(),
                                   [](const Channel& one) { return !one.had_copies.empty(); });
  const auto usual = std::count_if(channels_.begin(), channels_.end(),
                                   [](const Channel& one) { return one.are_usual; });
  return channels_.at(index_of(channel)).are_usual || 2 * usual > heard;
}

void Copies::note_choice(PulseChannel channel, bool later) {
  std::deque<bool>& choices = channels_.at(index_of(channel)).later;
  choices.push_back(later);
  if (choices.size() > kLast) {
    choices.pop_front();
  }
}

std::optional<bool> Copies::is_later(PulseChannel channel) const {
  const std::deque<bool>& choices = channels_.at(index_of(channel)).later;
  if (!are_usual(channel) || choices.size() < kLast) {
    return std::nullopt;
  }
  // Fewest of the last choices for the later copy to count: a spoilt edge leaves it now and then.
  return std::count(choices.begin(), choices.end(), true) >= 3;
}

bool Copies::disagree_with_others(PulseChannel channel) const {
  if (is_later(channel) != true) {
    return false;
  }
  for (std::size_t other = 0; other < kPulseChannels; ++other) {
    if (is_later(static_cast<PulseChannel>(other)) == false) {
      return true;
    }
  }
  return false;
}

bool Copies::are_apart(PulseChannel channel, double noise_s) const {
  const std::deque<double>& behind_s = channels_.at(index_of(channel)).behind_s;
  // Part of an edge's noise below which the median distance does not matter: the bias is up to 0.6
  // of that distance, and so no more than the noise of a mean of thousands of edges.
  return are_usual(channel) && !behind_s.empty() && quantile(behind_s, 0.5) > 0.02 * noise_s;
}

bool Copies::are_in_any_order(PulseChannel channel, double noise_s) const {
  const std::deque<double>& behind_s = channels_.at(index_of(channel)).behind_s;
  // Interquartile range of the distances, in parts of their median, from which copies come in any
  // order: 1.2 where both orders are equally likely, 0.8 where one holds in 95 of 100 revolutions,
  // and the bias is a fiftieth of the scatter.
  return are_apart(channel, noise_s) && behind_s.size() >= kFewestBehind &&
         quantile(behind_s, 0.75) - quantile(behind_s, 0.25) > 0.8 * quantile(behind_s, 0.5);
}

}  // namespace spindrift
