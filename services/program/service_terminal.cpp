#include "services/program/service_terminal.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/formatter.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string_view>

#include "pipelines/core/shown.h"
#include "services/alerts/alert_json.h"
#include "services/base/json_line.h"
#include "services/base/progress_bar.h"
#include "services/program/status_line.h"

namespace spindrift {
namespace {

// Durations of a silence after which it is logged again.
constexpr std::array<std::chrono::minutes, 2> kToldAfter{std::chrono::minutes{1},
                                                         std::chrono::minutes{5}};
constexpr std::chrono::seconds kRateOver{10};
constexpr std::size_t kUsualColumns = 80;

spdlog::level::level_enum level_of(AlertSeverity severity) {
  constexpr std::array<spdlog::level::level_enum, 3> kLevels = {
      spdlog::level::info, spdlog::level::warn, spdlog::level::critical};
  return kLevels.at(static_cast<std::size_t>(severity));
}

/// Describes the change of the alert and who made it.
std::string what_changed(const Alert& alert) {
  if (!alert.from || alert.from == AlertState::Cleared) {
    return alert.message;
  }
  if (alert.state == AlertState::Cleared) {
    return shown(alert.note);
  }
  return fmt::format("{} by {}{}{}", name_of(alert.state), shown(alert.by),
                     alert.note.empty() ? "" : ": ", shown(alert.note));
}

void log_change(const std::string& spacecraft, const Alert& alert) {
  const bool is_renewed = alert.by.empty() && alert.from == alert.state;
  if (is_renewed || (alert.state == AlertState::Cleared && alert.severity == AlertSeverity::Info)) {
    return;  // A new message alone is no news, nor is the end of an event.
  }
  const bool is_raised = !alert.from || alert.from == AlertState::Cleared;
  spdlog::log(is_raised ? level_of(alert.severity) : spdlog::level::info, "{}: {}: {}", spacecraft,
              shown(alert.key), what_changed(alert));
}

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

/// Leaves the last column free, since some terminals wrap when it is filled.
std::size_t columns_of_line() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return (known ? size.ws_col : kUsualColumns) - 1;
}

}  // namespace

TellAs how_to_tell(bool json) {
  return ::isatty(STDERR_FILENO) == 1 ? TellAs::StatusLine
         : json                       ? TellAs::JsonLines
                                      : TellAs::Lines;
}

void log_as_json() { spdlog::set_formatter(std::make_unique<JsonFormatter>()); }

ServiceTerminal::ServiceTerminal(const std::vector<Mission>& missions, TellAs as)
    : missions_{missions}, as_{as} {}

void ServiceTerminal::tell(const std::string& spacecraft, const std::string& run_id,
                           const Alert& alert) {
  if (as_ == TellAs::JsonLines) {
    fmt::print(stderr, "{}", json_line(alert_json(spacecraft, run_id, alert)));
  } else {
    log_change(spacecraft, alert);
  }
  if (alert.key == alert_key(AlertCode::LinkSilent, "")) {
    const std::lock_guard lock{mutex_};
    if (alert.state == AlertState::Active) {
      silences_.try_emplace(spacecraft, Silence{.severity = alert.severity});
    } else {
      silences_.erase(spacecraft);
    }
  }
}

void ServiceTerminal::show(const Health& health) {
  const std::lock_guard lock{mutex_};
  for (const SpacecraftHealth& one : health.spacecraft) {
    remind(one);
  }
  if (has_status_line()) {
    draw(health);
  }
}

void ServiceTerminal::remind(const SpacecraftHealth& health) {
  const auto silence = silences_.find(health.spacecraft);
  if (silence == silences_.end() || !health.data_age_s) {
    return;
  }
  const std::chrono::duration<double> age{*health.data_age_s};
  for (std::size_t& told = silence->second.told;
       told < kToldAfter.size() && age >= kToldAfter.at(told); ++told) {
    spdlog::log(level_of(silence->second.severity), "{}: {}: no telemetry for {} min",
                health.spacecraft, alert_key(AlertCode::LinkSilent, ""),
                kToldAfter.at(told).count());
  }
}

void ServiceTerminal::draw(const Health& health) {
  const auto& all = health.spacecraft;
  const auto is_heard = [](const SpacecraftHealth& one) { return one.data_age_s.has_value(); };
  const auto heard = static_cast<std::size_t>(std::count_if(all.begin(), all.end(), is_heard));
  const std::size_t turn = heard == 0 ? 0 : turn_++ % heard;
  std::size_t place = 0;
  for (const SpacecraftHealth& one : all) {
    const TalliedArrivals arrivals = arrivals_.of(one.spacecraft);
    const auto rate =
        rate_hz(counts_[one.spacecraft], std::chrono::steady_clock::now(), arrivals.samples);
    const auto mission = std::find_if(
        missions_.begin(), missions_.end(),
        [&](const Mission& candidate) { return candidate.spacecraft_id == one.spacecraft; });
    if (mission == missions_.end() || (heard > 0 && !is_heard(one)) || place++ != turn) {
      continue;
    }
    draw_last_line(status_line(*mission, one, arrivals, rate, columns_of_line()));
  }
}

std::optional<double> ServiceTerminal::rate_hz(Counts& counts, Instant now, std::int64_t samples) {
  counts.emplace_back(now, samples);
  while (now - counts.front().first > kRateOver) {
    counts.pop_front();
  }
  const auto& [since, before] = counts.front();
  const std::chrono::duration<double> span = now - since;
  return span.count() > 0.0 ? std::optional{static_cast<double>(samples - before) / span.count()}
                            : std::nullopt;
}

void ServiceTerminal::erase() const {
  if (has_status_line()) {
    draw_last_line("");
  }
}

}  // namespace spindrift
