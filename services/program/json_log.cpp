#include "services/program/json_log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/formatter.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "services/base/json_line.h"

namespace spindrift {
namespace {

class JsonFormatter : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
    using std::chrono::milliseconds;
    const auto ms =
        std::chrono::duration_cast<milliseconds>(message.time.time_since_epoch()) % 1000;
    const std::string_view text{message.payload.data(), message.payload.size()};
    const auto level = spdlog::level::to_string_view(message.level);
    const std::string json = json_line(
        {{"utc", fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z",
                             fmt::gmtime(spdlog::log_clock::to_time_t(message.time)), ms.count())},
         {"level", std::string_view{level.data(), level.size()}},
         {"text", text}});
    line.append(json.data(), json.data() + json.size());
  }
  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<JsonFormatter>();
  }
};

}  // namespace

void log_as_json() { spdlog::set_formatter(std::make_unique<JsonFormatter>()); }

}  // namespace spindrift
