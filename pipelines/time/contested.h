/// @file
/// Decides which of several contradicting samples of one kind and instant counts.

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

/// Returns whether two of the samples contradict each other (say_the_same).
/// @param said All samples of one kind and instant, in order of arrival.
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

/// Returns the first sample if all agree, else the first that agrees with the preferred sender. The
/// order of arrival does not decide between contradicting samples.
/// @return Empty if none counts.
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

/// Adds a sample to those of its instant, unless its sender has sent the same before or too many
/// are held; a larger limit ensures that the preferred sender is heard.
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

/// Collects contradicting samples that wait in the reorder window. Nothing is decided before the
/// sample is due.
/// @tparam Sample As for BasicReorderWindow, with sender_of and say_the_same.
template <class Sample>
class Contested {
 public:
  /// Precondition: `again` has the kind and instant of `held`.
  void record(const Sample& held, const Sample& again) {
    const auto known = said_.find(held);
    if (known != said_.end()) {
      add_to(known->second, again);
    } else if (!say_the_same(held, again) ||
               // Others may contradict it later.
               (sender_of(again) == Sender::Preferred && sender_of(held) != Sender::Preferred)) {
      said_.emplace(held, std::vector<Sample>{held, again});
    }
  }

  /// Returns all samples contending with `due`, which is due now; `due` itself comes first.
  std::vector<Sample> release(const Sample& due) {
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

/// Returns the samples that count among samples of one kind in time order.
/// @param see Called as `see(said, used)` for each contested instant.
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

/// Returns the senders of a late contradiction; the first sample counts.
template <class Sample>
std::vector<SampleContradiction::By> late_senders(const Sample& first, const Sample& late) {
  return {{.sender = sender_of(first), .used = true}, {.sender = sender_of(late), .used = false}};
}

/// Returns the senders of one instant. @param used The sample that counts; empty if none does.
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
