/// @file
/// Waits for asynchronous conditions.

#pragma once

#include <chrono>
#include <thread>

namespace spindrift {

/// Waits for `condition`.
/// @return False if it is not met within the deadline, which is long because only a failing test
/// waits for it.
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
