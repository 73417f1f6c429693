/// @file
/// Samples of one kind and instant that say different things, and which of them counts.

#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "pipelines/core/sender.h"
#include "pipelines/time/sample_contradiction.h"

namespace spindrift {

/// @param said All of one kind and instant, in the order in which they came. @return whether two of
/// them say different things (say_the_same).
template <class Sample>
bool is_contested(const std::vector<Sample>& said) {
  for (auto one = said.begin(); one != said.end(); ++one) {
    if (std::any_of(said.begin(), one,
                    [&](const Sample& other) { return !say_the_same(*one, other); })) {
      return true;
    }
  }
  return false;
}

/// The first, if they say the same; otherwise the first that says what the preferred sender does.
/// The order in which different ones came does not tell.
/// @return empty: none counts.
template <class Sample>
std::optional<Sample> one_that_counts(const std::vector<Sample>& said) {
  if (!is_contested(said)) {
    return said.front();
  }
  std::vector<Sample> preferred;
  std::copy_if(said.begin(), said.end(), std::back_inserter(preferred),
               [](const Sample& one) { return sender_of(one) == Sender::Preferred; });
  if (preferred.empty() || is_contested(preferred)) {
    return std::nullopt;
  }
  return *std::find_if(said.begin(), said.end(),
                       [&](const Sample& one) { return say_the_same(one, preferred.front()); });
}

/// `sample` beside those of its instant, unless its sender has said so before or too many have
/// spoken, of whom the preferred one must be heard.
template <class Sample>
void add_to(std::vector<Sample>& said, const Sample& sample) {
  const std::size_t most = sender_of(sample) == Sender::Preferred ? 32 : 16;
  const bool is_known = std::any_of(said.begin(), said.end(), [&](const Sample& other) {
    return sender_of(other) == sender_of(sample) && say_the_same(other, sample);
  });
  if (!is_known && said.size() < most) {
    said.push_back(sample);
  }
}

/// Of what waits for the order of time: what came again with another value. Nothing is decided
/// before the turn of the sample has come.
/// @tparam Sample As of BasicReorderWindow, with sender_of and say_the_same.
template <class Sample>
class Contested {
 public:
  /// `again` is of the kind and instant of `held`.
  void note(const Sample& held, const Sample& again) {
    const auto known = said_.find(held);
    if (known != said_.end()) {
      add_to(known->second, again);
    } else if (!say_the_same(held, again) ||
               // It may be contradicted yet.
               (sender_of(again) == Sender::Preferred && sender_of(held) != Sender::Preferred)) {
      said_.emplace(held, std::vector<Sample>{held, again});
    }
  }

  /// All that was said in the place of `due`, whose turn has come, itself first.
  std::vector<Sample> take(const Sample& due) {
    const auto known = said_.empty() ? said_.end() : said_.find(due);
    if (known == said_.end()) {
      return {};
    }
    std::vector<Sample> said = std::move(known->second);
    said_.erase(known);
    return said;
  }

 private:
  std::map<Sample, std::vector<Sample>> said_;
};

/// Of samples of one kind, in order of time, those that count.
/// @param see `see(said, used)` is called with what is contested.
template <class Sample, class See>
std::vector<Sample> those_that_count(const std::vector<Sample>& samples, const See& see) {
  std::vector<Sample> counting;
  counting.reserve(samples.size());
  for (auto first = samples.begin(); first != samples.end();) {
    const auto end =
        std::find_if(first, samples.end(), [&](const Sample& one) { return one.t != first->t; });
    const std::vector<Sample> said(first, end);
    const auto used = one_that_counts(said);
    if (used) {
      counting.push_back(*used);
    }
    if (is_contested(said)) {
      see(said, used);
    }
    first = end;
  }
  return counting;
}

/// What came first counts.
template <class Sample>
std::vector<SampleContradiction::By> late_senders(const Sample& first, const Sample& late) {
  return {{.sender = sender_of(first), .used = true}, {.sender = sender_of(late), .used = false}};
}

/// Of what was said of one instant. @param used What counts of it; empty: none.
template <class Sample>
std::vector<SampleContradiction::By> senders_of(const std::vector<Sample>& said,
                                                const std::optional<Sample>& used) {
  std::vector<SampleContradiction::By> by;
  for (const Sample& one : said) {
    const Sender sender = sender_of(one);
    if (std::none_of(by.begin(), by.end(),
                     [&](const auto& other) { return other.sender == sender; })) {
      by.push_back({.sender = sender, .used = used && sender == Sender::Preferred});
    }
  }
  return by;
}

}  // namespace spindrift
