#include "services/ingest/other_services.h"

#include <cstdint>

#include "services/bus/qos.h"
#include "services/bus/topics.h"

namespace spindrift {
namespace {

// Limit of spacecraft that are tracked, to bound memory.
constexpr std::size_t kMostServed = 4096;

}  // namespace

Expected<OtherServices> OtherServices::create(const bus::Participant& participant,
                                              const std::string& own) {
  return bus::Reader<spindrift_Health>::create(
             participant, bus::kHealthTopic, bus::results_qos(),
             [own](const spindrift_Health& health) { return own != health.service; })
      .map([](bus::Reader<spindrift_Health>&& reader) { return OtherServices{std::move(reader)}; });
}

Expected<std::map<std::string, std::string>> OtherServices::look(Instant now) {
  const auto note = [&](const spindrift_Health& health) {
    for (std::uint32_t i = 0; i < health.spacecraft._length; ++i) {
      const std::string spacecraft = health.spacecraft._buffer[i].spacecraft;
      if (heard_.size() < kMostServed || heard_.contains(spacecraft)) {
        heard_.insert_or_assign(spacecraft, Heard{.service = health.service, .last = now});
      }
    }
  };
  if (const auto taken = reader_.take(note); !taken) {
    return Unexpected{taken.error()};
  }
  std::erase_if(heard_, [&](const auto& one) { return now - one.second.last > kEndedAfter; });
  std::map<std::string, std::string> services;
  for (const auto& [spacecraft, heard] : heard_) {
    services.emplace(spacecraft, heard.service);
  }
  return services;
}

}  // namespace spindrift
