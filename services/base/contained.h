/// @file
/// An exception ends at the edge of its thread.

#pragma once

#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <type_traits>

#include "pipelines/core/expected.h"

namespace spindrift {

/// What `work` gives, an Expected<void> or nothing; an exception that escapes it as a failure.
/// Uncaught it would end the process from within a thread, and with it all that is accepted and not
/// yet stored. @param doing What the thread does, for the message. @return Unavailable.
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
