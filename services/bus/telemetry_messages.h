/// @file
/// The topics of telemetry, and the generated types of their messages.

#pragma once

#include <spindrift.h>

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "services/bus/topics.h"
#include "services/telemetry/by_kind.h"

namespace spindrift::bus {

/// Defines `Type`, the generated type, and `fields`, its members behind t_tai_ns.
template <BusMessage message>
struct Generated;

template <>
struct Generated<BusMessage::Pulse> {
  using Type = spindrift_Pulse;
  static const dds_topic_descriptor_t* descriptor() { return &spindrift_Pulse_desc; }
  static auto fields(auto& m) { return std::tie(m.channel); }
};

template <>
struct Generated<BusMessage::CodedFrame> {
  using Type = spindrift_CodedFrame;
  static const dds_topic_descriptor_t* descriptor() { return &spindrift_CodedFrame_desc; }
  static auto fields(auto& m) {
    return std::tie(m.period_s, m.sun2_s, m.north_in_s, m.north_out_s, m.south_in_s, m.south_out_s);
  }
};

template <>
struct Generated<BusMessage::VectorSample> {
  using Type = spindrift_VectorSample;
  static const dds_topic_descriptor_t* descriptor() { return &spindrift_VectorSample_desc; }
  static auto fields(auto& m) { return std::tie(m.x, m.y, m.z); }
};

template <>
struct Generated<BusMessage::StarFix> {
  using Type = spindrift_StarFix;
  static const dds_topic_descriptor_t* descriptor() { return &spindrift_StarFix_desc; }
  static auto fields(auto& m) { return std::tie(m.qx, m.qy, m.qz, m.qw); }
};

template <>
struct Generated<BusMessage::OrbitState> {
  using Type = spindrift_OrbitState;
  static const dds_topic_descriptor_t* descriptor() { return &spindrift_OrbitState_desc; }
  static auto fields(auto& m) {
    return std::tie(m.position_km[0], m.position_km[1], m.position_km[2], m.velocity_km_s[0],
                    m.velocity_km_s[1], m.velocity_km_s[2]);
  }
};

template <class Value>
using MessageOf = typename Generated<Telemetry<Value>::kMessage>::Type;

template <class Value>
Topic<MessageOf<Value>> topic_of() {
  return {Telemetry<Value>::kTopic, Generated<Telemetry<Value>::kMessage>::descriptor()};
}

/// Calls `see(name, member, field)` for each column of `value` with its member of `message`.
template <class Value, class Message, class See>
void for_each_field(Value& value, Message& message, See&& see) {
  using Kind = Telemetry<std::remove_const_t<Value>>;
  const auto fields = Generated<Kind::kMessage>::fields(message);
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (see(std::get<i>(Kind::kColumns).name, std::get<i>(Kind::kColumns).of(value),
         std::get<i>(fields)),
     ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(fields)>>{});
}

}  // namespace spindrift::bus
