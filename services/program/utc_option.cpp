#include "services/program/utc_option.h"

#include <fmt/format.h>

#include "pipelines/time/utc.h"
#include "services/program/outcome.h"

namespace spindrift {

Expected<TaiTime> utc_option(std::string_view option, const std::string& text) {
  const auto t = parse_utc(text);
  if (!t) {
    return refused(fmt::format("{}: {}", option, t.error().message));
  }
  if (!text.ends_with('Z')) {
    return refused(fmt::format("{} {}: must be UTC and end in Z", option, text));
  }
  return *t;
}

}  // namespace spindrift
