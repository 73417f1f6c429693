#include "services/processor/stored_samples.h"

namespace spindrift {

StoredSamples::StoredSamples(const StoredPass& stored) {
  keys_.reserve(count_of(stored.values));
  stored.values.for_each([this](const auto& of_kind) {
    for (const auto& arrived : of_kind) {
      keys_.push_back(key_of(arrived.value, is_preferred(arrived.value)));
    }
  });
  std::sort(keys_.begin(), keys_.end());
}

}  // namespace spindrift
