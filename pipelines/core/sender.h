/// @file
/// The sender of a sample.

#pragma once

#include <cstdint>

namespace spindrift {

/// Numbers the senders; the input layer knows their names. The value of the preferred sender counts
/// if samples contradict each other.
enum class Sender : std::uint32_t { Preferred = 0, First = 1 };

template <class Sample>
constexpr Sender sender_of(const Sample& sample) requires requires {
  sample.sender;
}
{ return sample.sender; }

}  // namespace spindrift
