/// @file
/// Publishes products and health on the bus.

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

/// Publishes results. A slow subscriber holds it up for a tenth of a second at most: a late result
/// is of no use, and the next one replaces it.
class ResultPublisher {
 public:
  /// `participant` must outlive the publisher.
  /// @param service Name of the instance, at most 64 bytes.
  /// @return Unavailable when Cyclone refuses.
  static Expected<ResultPublisher> create(const bus::Participant& participant, std::string service);

  /// Publishes a product on the topic of its kind, or as the products it is announced as. A product
  /// with neither is ignored, and one whose is_announced is false must not be passed (see
  /// announcements.h). @return InvalidInput for a name that does not fit (to_idl.h), Unavailable
  /// when the bus refuses.
  Expected<void> publish(std::string_view spacecraft, std::string_view run_id,
                         const Product& product) const;
  /// Publishes health on spindrift/health; errors as for products.
  Expected<void> publish(const Health& health) const;

  /// Describes, one sentence each, the discovered subscribers that request more than is offered;
  /// see services/bus/endpoints.h. @return Unavailable when Cyclone refuses.
  Expected<std::vector<std::string>> incompatible_readers() const;

 private:
  using Writers = std::map<std::size_t, bus::UntypedWriter>;  ///< Writers by kind of product.

  ResultPublisher(std::string service, Writers products, bus::Writer<spindrift_Health> health)
      : service_{std::move(service)}, products_{std::move(products)}, health_{std::move(health)} {}

  std::string service_;
  Writers products_;
  bus::Writer<spindrift_Health> health_;
};

}  // namespace spindrift
