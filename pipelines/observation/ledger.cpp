#include "pipelines/observation/ledger.h"

#include <algorithm>
#include <iterator>

namespace spindrift {
namespace {

constexpr double kMost = 0.5;

}  // namespace

void Ledger::add(std::span<const Observation> together) {
  all_.add(together);
  for (const Observation& observation : together) {
    Source& source = of_[index_of(observation.source)];
    source.record.add({&observation, 1});
    if (observation.residual.freedom == 1) {
      source.oscillation.add(observation.whitened());
    }
  }
  for (std::size_t i = 0; i < of_.size(); ++i) {
    const bool is_left_out =
        std::any_of(together.begin(), together.end(), [i](const Observation& observation) {
          return index_of(observation.source) == i && observation.rejected_by.has_value();
        });
    of_[i].turns_left_out.add(is_left_out ? 1.0 : 0.0);
  }
  ++turns_;
}

std::optional<SampleSource> Ledger::mostly_left_out() const {
  const auto worst = std::max_element(of_.begin(), of_.end(), [](const Source& a, const Source& b) {
    return a.turns_left_out.mean() < b.turns_left_out.mean();
  });
  return worst->turns_left_out.mean() > kMost
             ? std::optional{static_cast<SampleSource>(std::distance(of_.begin(), worst))}
             : std::nullopt;
}

std::vector<SourceSummary> Ledger::sources() const {
  std::vector<SourceSummary> all;
  for (std::size_t i = 0; i < of_.size(); ++i) {
    if (const ObservationRecord& record = of_[i].record; record.heard() > 0.0) {
      const double used = 1.0 - record.share_left_out();
      all.push_back({.source = static_cast<SampleSource>(i),
                     .used = used,
                     .noise = used > 0.0 ? std::optional{record.noise()} : std::nullopt});
    }
  }
  return all;
}

void Ledger::restart() {
  turns_ = 0;
  all_.restart();
  for (Source& source : of_) {
    source = Source{.record = source.record};
    source.record.restart();
  }
}

void Ledger::discard_transient(double most) {
  all_.discard_transient(most);
  for (Source& source : of_) {
    source.record.discard_transient(most);
    source.oscillation = {};
  }
}

}  // namespace spindrift
