#include "services/bus/loan.h"

#include <cstdint>

namespace spindrift::bus {
namespace {

Expected<std::size_t> count_of(dds_return_t taken) {
  if (taken < 0) {
    return Unexpected{dds_error("taking samples from a DDS reader", taken)};
  }
  return static_cast<std::size_t>(taken);
}

}  // namespace

Loan::Loan(const Entity& reader)
    : reader_{reader.handle()},
      count_{
          count_of(dds_take(reader_, samples_.data(), infos_.data(), kMaxSamples, kMaxSamples))} {}

Loan::~Loan() {
  if (count_.value_or(0) > 0) {
    // Fails only if nothing is on loan.
    static_cast<void>(
        dds_return_loan(reader_, samples_.data(), static_cast<std::int32_t>(*count_)));
  }
}

}  // namespace spindrift::bus
