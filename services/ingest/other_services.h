/// @file
/// Finds other services that report on a spacecraft in the same partition.

#pragma once

#include <spindrift.h>

#include <chrono>
#include <map>
#include <string>
#include <utility>

#include "services/bus/reader.h"

namespace spindrift {

/// Finds services by the health that each publishes once a second.
class OtherServices {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  /// A service not heard for longer than this has ended.
  static constexpr std::chrono::seconds kEndedAfter{5};

  /// `participant` must outlive this object. @param own Name of this service, which is left out.
  /// @return Unavailable when Cyclone refuses.
  static Expected<OtherServices> create(const bus::Participant& participant,
                                        const std::string& own);

  /// @return The service last heard for each spacecraft; Unavailable when Cyclone refuses.
  Expected<std::map<std::string, std::string>> look(Instant now);

 private:
  struct Heard {
    std::string service;
    Instant last;
  };

  explicit OtherServices(bus::Reader<spindrift_Health> reader) : reader_{std::move(reader)} {}

  bus::Reader<spindrift_Health> reader_;
  std::map<std::string, Heard> heard_;  ///< Last report for each spacecraft.
};

}  // namespace spindrift
