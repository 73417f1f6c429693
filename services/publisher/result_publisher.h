/// @file
/// Products and health out on the bus.

#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/bus/writer.h"
#include "services/products/products.h"
#include "services/publisher/health.h"

namespace spindrift {

/// A slow subscriber does not hold it up for longer than a tenth of a second: a late result is of
/// no use, and the next one replaces it.
class ResultPublisher {
 public:
  /// `participant` outlives it. @param service Names the instance; at most 64 bytes.
  /// @return Unavailable when Cyclone refuses.
  static Expected<ResultPublisher> create(const bus::Participant& participant, std::string service);

  /// On the topic of its kind, or as what it is announced as; what has neither, and what
  /// is_announced says no to, is not for publishing (see announcements.h).
  /// @return InvalidInput for a name that does not fit (to_idl.h), Unavailable when the bus
  /// refuses.
  Expected<void> publish(std::string_view spacecraft, std::string_view run_id,
                         const Product& product) const;
  /// On spindrift/health. @return likewise.
  Expected<void> publish(const Health& health) const;

  /// Subscribers in sight that ask for more than is offered, a sentence each; see
  /// services/bus/endpoints.h. @return Unavailable when Cyclone refuses.
  Expected<std::vector<std::string>> incompatible_readers() const;

 private:
  using Writers = std::map<std::size_t, bus::UntypedWriter>;  ///< By kind.

  ResultPublisher(std::string service, Writers products, bus::Writer<spindrift_Health> health)
      : service_{std::move(service)}, products_{std::move(products)}, health_{std::move(health)} {}

  std::string service_;
  Writers products_;
  bus::Writer<spindrift_Health> health_;
};

}  // namespace spindrift
