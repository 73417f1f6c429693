#include "services/processor/pass_watch.h"

namespace spindrift {

PassWatch::Verdict PassWatch::see(TaiTime t) {
  if (reached_ && t <= *reached_) {
    return Verdict::Within;
  }
  if (!reached_ || t - *reached_ <= kLongestSilence) {
    reached_ = t;
    beyond_ = 0;
    return Verdict::Onward;
  }
  return ++beyond_ < kBelieved ? Verdict::Undecided : Verdict::NewPass;
}

}  // namespace spindrift
