/// @file
/// Products and health out on the bus.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipelines/spin/types/products.h"
#include "services/bus/writer.h"
#include "services/publisher/health.h"

namespace spindrift {

/// A slow subscriber does not hold it up for longer than a tenth of a second: a late result is of
/// no use, and the next one replaces it.
class ResultPublisher {
 public:
  /// `participant` outlives it. @param service Names the instance; at most 64 bytes.
  /// @return Unavailable when Cyclone refuses.
  static Expected<ResultPublisher> create(const bus::Participant& participant, std::string service);

  /// On spindrift/spin_fix, where its resolution tells an ambiguous fix, and nothing one that was
  /// left out for another reason: that is not for publishing (see announcements.h).
  /// @return InvalidInput for a name that does not fit (to_idl.h), Unavailable when the bus
  /// refuses.
  Expected<void> publish(std::string_view spacecraft, std::string_view run_id,
                         const SpinFix& fix) const;
  /// On spindrift/spin_estimate. @return likewise.
  Expected<void> publish(std::string_view spacecraft, std::string_view run_id,
                         const SpinEstimate& estimate) const;
  /// On spindrift/health. @return likewise.
  Expected<void> publish(const Health& health) const;

  /// Subscribers in sight that ask for more than is offered, a sentence each; see
  /// services/bus/endpoints.h. @return Unavailable when Cyclone refuses.
  Expected<std::vector<std::string>> incompatible_readers() const;

 private:
  ResultPublisher(std::string service, bus::Writer<spindrift_SpinFix> spin_fix,
                  bus::Writer<spindrift_SpinEstimate> spin_estimate,
                  bus::Writer<spindrift_Health> health)
      : service_{std::move(service)},
        spin_fix_{std::move(spin_fix)},
        spin_estimate_{std::move(spin_estimate)},
        health_{std::move(health)} {}

  std::string service_;
  bus::Writer<spindrift_SpinFix> spin_fix_;
  bus::Writer<spindrift_SpinEstimate> spin_estimate_;
  bus::Writer<spindrift_Health> health_;
};

}  // namespace spindrift
