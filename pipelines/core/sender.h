/// @file
/// Who sent a sample.

#pragma once

#include <cstdint>

namespace spindrift {

/// A number for it: whoever takes samples in knows the names. Preferred: the one whose value counts
/// where samples contradict each other.
enum class Sender : std::uint32_t { Preferred = 0, First = 1 };

template <class Sample>
constexpr Sender sender_of(const Sample& sample) requires requires {
  sample.sender;
}
{ return sample.sender; }

}  // namespace spindrift
