#include "services/processor/pass_watch.h"

namespace spindrift {

PassWatch::Verdict PassWatch::judge(TaiTime t, std::size_t kind) {
  if (reached_ && t <= *reached_) {
    ++within_;
    jump_.register_kind(kind);
    return Verdict::Within;
  }
  const bool silent = reached_ && t - *reached_ > kLongestSilence;
  if (silent) {
    ++beyond_;
    jump_.add_ahead(t, kind);
    if (!jump_.has_shown()) {
      return Verdict::Undecided;
    }
  }
  if (silent && within_ >= kEnoughToAccept) {
    return Verdict::NewPass;
  }
  within_ += beyond_ + (silent ? 0 : 1);
  reached_ = t;
  beyond_ = 0;
  jump_.hear(kind);
  return Verdict::Onward;
}

}  // namespace spindrift
