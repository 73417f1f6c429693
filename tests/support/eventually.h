/// @file
/// Waiting for what others do in their own time.

#pragma once

#include <chrono>
#include <thread>

namespace spindrift {

/// Waits for `condition`. @return false when it does not come, which only a failing test sees.
template <class Condition>
bool eventually(const Condition& condition) {
  using namespace std::chrono_literals;
  const auto deadline = std::chrono::steady_clock::now() + 120s;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(2ms);
  }
  return true;
}

}  // namespace spindrift
