#include "services/processor/pass_watch.h"

namespace spindrift {

PassWatch::Verdict PassWatch::see(TaiTime t) {
  if (reached_ && t <= *reached_) {
    ++within_;
    return Verdict::Within;
  }
  const bool silent = reached_ && t - *reached_ > kLongestSilence;
  if (silent && ++beyond_ < kEnoughToAccept) {
    return Verdict::Undecided;
  }
  if (silent && within_ >= kEnoughToAccept) {
    return Verdict::NewPass;
  }
  within_ += beyond_ + (silent ? 0 : 1);
  reached_ = t;
  beyond_ = 0;
  return Verdict::Onward;
}

}  // namespace spindrift
