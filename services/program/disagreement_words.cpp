#include "services/program/disagreement_words.h"

#include <fmt/format.h>

#include "services/base/decimals.h"

namespace spindrift {

std::string sentence_of(const Disagreement& disagreement) {
  constexpr int kLeast = 3;
  const double sigma_deg = disagreement.apart_deg / disagreement.apart_sigmas;
  return fmt::format(
      "{} and {} disagree: their axes are {:.{}f} deg apart, {:.1f} times the larger sigma",
      disagreement.one, disagreement.other, disagreement.apart_deg, decimals_for(sigma_deg, kLeast),
      disagreement.apart_sigmas);
}

}  // namespace spindrift
