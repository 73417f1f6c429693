#include "pipelines/supervision/answer_presence.h"

namespace spindrift {
namespace {

// Longer silences are the link's or the sensors', and have alerts of their own.
constexpr double kGap_s = 15.0;

}  // namespace

std::optional<ConditionChange> AnswerPresence::see_sample(TaiTime t) {
  if (reached_ && t <= *reached_) {
    return std::nullopt;
  }
  const double step_s = reached_ ? seconds_between(*reached_, t) : 0.0;
  reached_ = t;
  without_s_ += step_s <= kGap_s ? step_s : 0.0;
  const auto later = answers_.upper_bound(t);
  if (later != answers_.begin()) {
    answers_.erase(answers_.begin(), later);
    without_s_ = 0.0;
  }
  return watch_.update(t, {.value = without_s_, .limit = limit_s_});
}

}  // namespace spindrift
