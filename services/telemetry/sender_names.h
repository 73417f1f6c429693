/// @file
/// Numbers for the telemetry sources, as the pipelines know them.

#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/core/sender.h"
#include "services/telemetry/telemetry_sample.h"

namespace spindrift {

/// Source names indexed by number.
using NamesOfSenders = std::shared_ptr<const std::vector<std::string>>;

/// Numbers sources in the order in which they are first heard, after the preferred one, which is 0.
/// Sources beyond kMost share one number.
class SenderNames {
 public:
  static constexpr std::size_t kMost = 256;

  /// @param preferred Empty when no source is preferred.
  explicit SenderNames(std::string preferred)
      : names_{std::make_shared<std::vector<std::string>>(1, std::move(preferred))} {}

  const std::string& preferred() const { return names_->front(); }
  const NamesOfSenders& names() const { return names_; }

  Sender number_of(const std::string& source) {
    if (source != (*names_)[last_] || (last_ == 0 && source.empty())) {
      last_ = place_of(source);
    }
    return static_cast<Sender>(last_);
  }

  /// Sets the sample's sender to the number of its source, if its kind has one.
  template <class Value>
  void put_into(TelemetrySample<Value>& sample) {
    if constexpr (requires { sample.value.sender; }) {
      sample.value.sender = number_of(sample.origin.source);
    }
  }

 private:
  std::size_t place_of(const std::string& source) {
    const bool may_be_preferred = !preferred().empty();
    const auto found =
        std::find(names_->begin() + (may_be_preferred ? 0 : 1), names_->end(), source);
    if (found != names_->end()) {
      return static_cast<std::size_t>(found - names_->begin());
    }
    if (names_->size() > kMost) {
      return kMost;
    }
    auto more = std::make_shared<std::vector<std::string>>(*names_);
    more->push_back(more->size() == kMost ? "(other sources)" : source);
    names_ = std::move(more);
    return names_->size() - 1;
  }

  NamesOfSenders names_;
  std::size_t last_ = 0;  ///< Source of the latest sample.
};

}  // namespace spindrift
