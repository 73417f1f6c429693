#include "services/bus/cyclone_log.h"

#include <dds/ddsrt/log.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <mutex>

#include "pipelines/core/shown.h"

namespace spindrift::bus {
namespace {

spdlog::level::level_enum level_of(std::uint32_t priority) {
  if ((priority & (DDS_LC_FATAL | DDS_LC_ERROR)) != 0) {
    return spdlog::level::err;
  }
  return (priority & DDS_LC_WARNING) != 0 ? spdlog::level::warn : spdlog::level::info;
}

/// Called from any thread of Cyclone.
void say(void* /*unused*/, const dds_log_data_t* entry) {
  static std::mutex mutex;
  static LogLimit limit;
  const std::lock_guard lock{mutex};
  const auto left_out = limit.pass(entry->file, entry->line, std::chrono::steady_clock::now());
  if (!left_out) {
    return;
  }
  std::string_view message = entry->message;
  while (message.ends_with('\n')) {
    message.remove_suffix(1);
  }
  spdlog::log(level_of(entry->priority), "Cyclone DDS: {}{}", shown(message),
              *left_out == 0 ? std::string{}
                             : fmt::format(" ({} such lines before it left out)", *left_out));
}

}  // namespace

std::optional<std::uint64_t> LogLimit::pass(std::string_view file, std::uint32_t line, Time now) {
  const auto [found, is_new] =
      places_.try_emplace({std::string{file}, line}, Place{.said = now, .left_out = 0});
  Place& place = found->second;
  if (!is_new && now - place.said < kPeriod) {
    ++place.left_out;
    return std::nullopt;
  }
  place.said = now;
  return std::exchange(place.left_out, 0);
}

void log_what_cyclone_says() { dds_set_log_sink(&say, nullptr); }

}  // namespace spindrift::bus
