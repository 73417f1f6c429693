#include "services/processor/pass_computing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <tuple>

#include "pipelines/time/utc.h"
#include "services/base/notice_words.h"
#include "services/processor/told.h"

namespace spindrift {
namespace {

std::optional<TaiTime> time_of(const Notice& notice) {
  for (const NamedValue& value : notice.values) {
    if (const auto* const t_tai_ns = std::get_if<std::int64_t>(&value.value);
        t_tai_ns != nullptr && (value.name == "t_tai_ns" || value.name == "first_tai_ns")) {
      return tai_from_ns(*t_tai_ns);
    }
  }
  return std::nullopt;
}

}  // namespace

RunFault fault_of(const std::string& spacecraft_id, const std::string& run_id, TaiTime t,
                  std::string what) {
  spdlog::error(
      "{}: computing failed at {}: {}: run {} is DOUBTFUL, its samples are stored, and nothing "
      "more is computed of it",
      spacecraft_id, format_utc(t), what, run_id);
  return {.t = t, .what = std::move(what)};
}

std::vector<RunNotice> told(const std::string& spacecraft_id, const std::vector<Notice>& notices) {
  std::vector<RunNotice> all;
  for (const Notice& notice : notices) {
    nlohmann::json values = values_of(notice);
    values["spacecraft"] = spacecraft_id;
    all.push_back(told(name_of(notice.code), values,
                       fmt::format("{}: {}", spacecraft_id, sentence_of(notice)), time_of(notice)));
  }
  return all;
}

void fill_in_names(SampleContradiction& contradiction, const std::vector<std::string>& names) {
  for (SampleContradiction::By& by : contradiction.by) {
    const auto number = static_cast<std::size_t>(by.sender);
    by.name = number < names.size() ? names[number] : std::string{};
  }
  std::sort(contradiction.by.begin(), contradiction.by.end(),
            [](const auto& one, const auto& other) {
              return std::tie(one.name, one.used) < std::tie(other.name, other.used);
            });
}

RunNotice told(const std::string& spacecraft_id, const SampleContradiction& contradiction) {
  std::vector<std::string> sources;
  std::string used;
  for (const SampleContradiction::By& by : contradiction.by) {
    if (std::find(sources.begin(), sources.end(), by.name) == sources.end()) {
      sources.push_back(by.name);
    }
    used = by.used ? by.name : used;
  }
  const std::string decision =
      used.empty()
          ? "none of them is used; [sources] prefer in the mission file may name one that is"
          : fmt::format("that of {} is used", used);
  return told("contradiction",
              {{"spacecraft", spacecraft_id},
               {"kind", contradiction.kind},
               {"t_tai_ns", tai_ns(contradiction.t)},
               {"sources", sources}},
              fmt::format("{}: {} samples of one time have different values, first at {} from {}: "
                          "{}. All are in the table contradiction",
                          spacecraft_id, contradiction.kind, format_utc(contradiction.t),
                          fmt::join(sources, " and "), decision),
              contradiction.t);
}

}  // namespace spindrift
