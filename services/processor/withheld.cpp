#include "services/processor/withheld.h"

#include <algorithm>

namespace spindrift {

void Withheld::take_from(SpinOutput& output) {
  std::erase_if(output.products, [&](const SpinProduct& product) {
    const auto why = why_withheld(product);
    if (why && std::find(said_.begin(), said_.end(), *why) == said_.end()) {
      said_.push_back(*why);
      output.notices.push_back(*why);
    }
    return why.has_value();
  });
}

}  // namespace spindrift
