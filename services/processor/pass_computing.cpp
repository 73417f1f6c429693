#include "services/processor/pass_computing.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "pipelines/time/utc.h"
#include "services/standard_error/warning.h"
#include "services/words/notice_words.h"

namespace spindrift {

RunFault fault_of(const std::string& spacecraft_id, const std::string& run_id, TaiTime t,
                  std::string what) {
  spdlog::error(
      "{}: computing failed at {}: {}: run {} is DOUBTFUL, its samples are stored, and nothing "
      "more is computed of it",
      spacecraft_id, format_utc(t), what, run_id);
  return {.t = t, .what = std::move(what)};
}

void say(const std::string& spacecraft_id, const std::vector<Notice>& notices) {
  for (const Notice& notice : notices) {
    nlohmann::json values = values_of(notice);
    values["spacecraft"] = spacecraft_id;
    warn(name_of(notice.code), std::move(values),
         fmt::format("{}: {}", spacecraft_id, sentence_of(notice)));
  }
}

}  // namespace spindrift
