/// @file
/// Access to samples in the middleware's memory without copying them.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "services/bus/entity.h"

namespace spindrift::bus {

/// Takes up to 256 samples on loan from the middleware and returns them on destruction.
class Loan {
 public:
  static constexpr std::size_t kMaxSamples = 256;

  explicit Loan(const Entity& reader);
  ~Loan();
  Loan(const Loan&) = delete;
  Loan& operator=(const Loan&) = delete;
  Loan(Loan&&) = delete;
  Loan& operator=(Loan&&) = delete;

  /// Returns the number of samples taken; Unavailable when Cyclone refused.
  const Expected<std::size_t>& count() const { return count_; }

  /// Null when the sample only reports that its writers ended or disposed of the instance.
  const void* operator[](std::size_t i) const {
    return infos_[i].valid_data ? samples_[i] : nullptr;
  }
  /// Returns when the sample was written, in nanoseconds of the writer's clock.
  std::int64_t written_ns(std::size_t i) const { return infos_[i].source_timestamp; }

 private:
  dds_entity_t reader_;
  std::array<void*, kMaxSamples> samples_{};
  std::array<dds_sample_info_t, kMaxSamples> infos_{};
  Expected<std::size_t> count_;
};

}  // namespace spindrift::bus
