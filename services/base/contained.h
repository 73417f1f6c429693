/// @file
/// Turns exceptions that escape the work of a thread into errors.

#pragma once

#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <type_traits>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Returns what `work` returns (an Expected<void> or nothing), and an escaping exception as an
/// error. Uncaught it would end the process, and lose all that is accepted but not yet stored.
/// @param doing What the thread does, for the message. @return Unavailable.
template <class Work>
Expected<void> contained(std::string_view doing, const Work& work) {
  const auto failed = [doing](std::string_view why) {
    return Unexpected{{ErrorCode::Unavailable, std::string{doing}.append(": ").append(why)}};
  };
  try {
    if constexpr (std::is_void_v<std::invoke_result_t<const Work&>>) {
      work();
      return {};
    } else {
      return work();
    }
  } catch (const std::bad_alloc& /*exception*/) {
    return failed("out of memory");
  } catch (const std::exception& exception) {
    return failed(exception.what());
  }
}

}  // namespace spindrift
