/// @file
/// Maps products to their topics and to the generated types of their messages.

#pragma once

#include <spindrift.h>

#include "services/bus/topics.h"
#include "services/products/products.h"

namespace spindrift {

/// Has the generated type that to_idl fills as `Type`. Specialised for each product with a topic.
template <PublishedProduct Product>
struct ProductMessage;

template <>
struct ProductMessage<SpinFix> {
  using Type = spindrift_SpinFix;
  static const dds_topic_descriptor_t* descriptor() { return &spindrift_SpinFix_desc; }
};

template <>
struct ProductMessage<SpinEstimate> {
  using Type = spindrift_SpinEstimate;
  static const dds_topic_descriptor_t* descriptor() { return &spindrift_SpinEstimate_desc; }
};

template <>
struct ProductMessage<AttitudeEstimate> {
  using Type = spindrift_AttitudeEstimate;
  static const dds_topic_descriptor_t* descriptor() { return &spindrift_AttitudeEstimate_desc; }
};

template <>
struct ProductMessage<Alert> {
  using Type = spindrift_Alert;
  static const dds_topic_descriptor_t* descriptor() { return &spindrift_Alert_desc; }
};

template <PublishedProduct Product>
bus::Topic<typename ProductMessage<Product>::Type> product_topic() {
  return {ProductKind<Product>::kTopic, ProductMessage<Product>::descriptor()};
}

}  // namespace spindrift
