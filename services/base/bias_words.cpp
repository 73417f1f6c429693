#include "services/base/bias_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>
#include <vector>

namespace spindrift {
namespace {

// In the order of SensorBias.
constexpr std::array<std::string_view, kSensorBiases> kBiasWords{
    "sun angle",
    "separation of the sun slits",
    "north chord",
    "south chord",
    "north mounting angle",
    "south mounting angle",
    "azimuth between sun sensor and beams",
    "height of the infrared horizon",
    "coning",
    "coning"};

std::vector<std::string_view> words_of(const BiasSet& biases) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < kSensorBiases; ++i) {
    // Coning has two successive unknowns of the same name.
    if (biases[i] && (words.empty() || words.back() != kBiasWords.at(i))) {
      words.push_back(kBiasWords.at(i));
    }
  }
  return words;
}

}  // namespace

std::string undetermined_sentence(const BiasSet& direction) {
  const std::vector<std::string_view> words = words_of(direction);
  if (words.size() < 2) {
    return fmt::format("{} is not determined in this geometry", fmt::join(words, ""));
  }
  return fmt::format("{} and {} cannot be told apart in this geometry",
                     fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

}  // namespace spindrift
