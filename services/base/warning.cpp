#include "services/base/warning.h"

#include <spdlog/spdlog.h>

#include <cstddef>
#include <mutex>
#include <utility>

namespace spindrift {
namespace {

constexpr std::size_t kMost = 1000;

// Global, like the log.
struct Said {
  std::mutex mutex;
  nlohmann::json warnings = nlohmann::json::array();
};
Said& said() {
  static Said of_process;
  return of_process;
}

}  // namespace

void warn(std::string_view code, nlohmann::json values, std::string text) {
  spdlog::warn("{}", text);
  Said& all = said();
  const std::lock_guard lock{all.mutex};
  if (all.warnings.size() < kMost) {
    all.warnings.push_back(
        {{"code", code}, {"values", std::move(values)}, {"text", std::move(text)}});
  }
}

nlohmann::json with_warnings(nlohmann::json object) {
  Said& all = said();
  const std::lock_guard lock{all.mutex};
  object["warnings"] = all.warnings;
  return object;
}

}  // namespace spindrift
