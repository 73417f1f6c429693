#include "pipelines/supervision/answer_presence.h"

namespace spindrift {
namespace {

// Longer silences are the link's or the sensors', and have alerts of their own.
constexpr double kGap_s = 15.0;
// From separation on minutes pass until a second sensor is switched on.
constexpr double kPatience = 5.0;

}  // namespace

void AnswerPresence::Waited::see(TaiTime t) {
  const double step_s = reached ? seconds_between(*reached, t) : 0.0;
  if (step_s >= 0.0) {
    reached = t;
    without_s += step_s <= kGap_s ? step_s : 0.0;
  }
}

std::optional<ConditionChange> AnswerPresence::see_sample(TaiTime t, bool is_usable) {
  all_.see(t);
  if (is_usable) {
    usable_.see(t);
  }
  const auto later = answers_.upper_bound(t);
  if (later != answers_.begin()) {
    answers_.erase(answers_.begin(), later);
    all_.without_s = 0.0;
    usable_.without_s = 0.0;
  }
  return watch_.update(
      t, all_.without_s > kPatience * usable_.without_s
             ? ConditionWatch::Reading{.value = all_.without_s, .limit = kPatience * limit_s_}
             : ConditionWatch::Reading{.value = usable_.without_s, .limit = limit_s_});
}

}  // namespace spindrift
