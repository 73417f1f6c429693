#include "services/base/advisory_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "services/base/decimals.h"
#include "services/base/degrees.h"

namespace spindrift {
namespace {

constexpr std::array<std::string_view, kSensorVoices> kVoiceWords{"speak", "left out", "silent",
                                                                  "never spoke"};

/// Returns "gyro, star silent", or nothing if there is no such sensor.
std::string sensors_that(SensorVoice voice, const SensorVoices& sensors) {
  std::vector<std::string_view> names;
  for (std::size_t kind = 0; kind < sensors.size(); ++kind) {
    if (sensors.at(kind) == voice) {
      names.push_back(name_of(static_cast<SampleKind>(kind)));
    }
  }
  return names.empty() ? std::string{}
                       : fmt::format("{} {}", fmt::join(names, ", "),
                                     kVoiceWords.at(static_cast<std::size_t>(voice)));
}

std::string sensors_text(const SensorVoices& sensors) {
  std::vector<std::string> texts;
  for (int voice = 0; voice < kSensorVoices; ++voice) {
    if (auto text = sensors_that(static_cast<SensorVoice>(voice), sensors); !text.empty()) {
      texts.push_back(std::move(text));
    }
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

std::string attitude_text(const std::optional<AttitudeEstimate>& attitude) {
  if (!attitude) {
    return "no attitude known";
  }
  return fmt::format("attitude by {}, {}, sigma {} deg", name_of(attitude->source),
                     name_of(attitude->assessment.quality),
                     to_its_digits(attitude->sigma_rad() * kDegPerRad, 4));
}

}  // namespace

std::string sentence_of(const Advisory& advisory) {
  return fmt::format(
      "body lost, by {}: the field is {:.1f} deg off that of the commanded attitude; {}; {}; {}",
      advisory.certain ? "field and Sun" : "the field alone", advisory.off_deg,
      sensors_text(advisory.sensors), attitude_text(advisory.attitude),
      advisory.may_control ? "the safe gate is open, control may restart"
                           : "no control before the safe gate opens");
}

}  // namespace spindrift
