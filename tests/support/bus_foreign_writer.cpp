/// @file
/// The program `bus_foreign_writer DOMAIN PARTITION KIND COUNT`, which writes pulses from another
/// process; see bus_child.h for the kinds.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <span>
#include <string>
#include <thread>

#include "services/bus/telemetry_messages.h"
#include "tests/support/bus_fixture.h"

namespace spindrift {
namespace {

using namespace std::chrono_literals;

bus::Qos weak_qos() {
  bus::Qos qos{dds_create_qos()};
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  return qos;
}

/// Returns telemetry_writer_qos with a short durability history: the full one allocates room for
/// minutes of samples for each spacecraft in advance.
bus::Qos short_qos() {
  bus::Qos qos = bus::telemetry_writer_qos();
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  return qos;
}

bus::Qos patient_qos() {
  bus::Qos qos = bus::telemetry_writer_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(60));
  return qos;
}

bus::Qos qos_of(const std::string& kind) {
  if (kind == "weak") {
    return weak_qos();
  }
  if (kind == "patient") {
    return patient_qos();
  }
  return kind == "keys" ? short_qos() : bus::telemetry_writer_qos();
}

/// Returns a type that has the name of the pulse type but only its first member and no type
/// information.
const dds_topic_descriptor_t& foreign_type() {
  static constexpr std::array<std::uint32_t, 6> kOps = {
      DDS_OP_ADR | DDS_OP_FLAG_KEY | DDS_OP_FLAG_MU | DDS_OP_TYPE_BST,
      offsetof(spindrift_Pulse, spacecraft),
      sizeof(spindrift_Pulse::spacecraft),
      DDS_OP_RTS,
      DDS_OP_KOF | 1U,
      0U};
  constexpr std::uint32_t kKeyOp = 4;
  static constexpr dds_key_descriptor_t kKey{
      .m_name = "spacecraft", .m_offset = kKeyOp, .m_idx = 0};
  static const dds_topic_descriptor_t type{.m_size = spindrift_Pulse_desc.m_size,
                                           .m_align = spindrift_Pulse_desc.m_align,
                                           .m_flagset = 0,
                                           .m_nkeys = spindrift_Pulse_desc.m_nkeys,
                                           .m_typename = spindrift_Pulse_desc.m_typename,
                                           .m_keys = &kKey,
                                           .m_nops = 2,
                                           .m_ops = kOps.data(),
                                           .m_meta = "",
                                           .type_information = {},
                                           .type_mapping = {},
                                           .restrict_data_representation = 0};
  return type;
}

spindrift_Pulse pulse_of(const std::string& kind, std::uint64_t seq) {
  spindrift_Pulse pulse = idl_pulse(seq);
  if (kind == "keys") {
    const std::span name{pulse.spacecraft};
    std::snprintf(name.data(), name.size(), "X%lu", static_cast<unsigned long>(seq));
  } else if (kind == "impossible") {
    pulse.t_tai_ns = -1;
  }
  return pulse;
}

Expected<void> write_all(const bus::Writer<spindrift_Pulse>& writer, const std::string& kind,
                         std::uint64_t count) {
  auto written = writer.wait_for_reader(30s);
  for (std::uint64_t seq = 0; seq < count && written; ++seq) {
    written = writer.write(pulse_of(kind, seq), std::stop_token{});
  }
  return written.and_then([&writer] { return writer.wait_for_acknowledgments(30s); });
}

int run(const bus::BusConfig& config, const std::string& kind, std::uint64_t count) {
  const auto participant = bus::Participant::create(config);
  auto topic = bus::topic_of<Pulse>();
  if (kind == "foreign") {
    topic.type = &foreign_type();
  }
  const auto writer =
      bus::Writer<spindrift_Pulse>::create(participant.value(), topic, qos_of(kind));
  if (kind == "weak") {
    std::this_thread::sleep_for(60s);
    return EXIT_FAILURE;
  }
  const auto written = write_all(writer.value(), kind, count);
  if (!written) {
    std::cerr << written.error().message << '\n';
  }
  return written ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace spindrift

int main(int argc, char** argv) {
  if (argc != 5) {
    return EXIT_FAILURE;
  }
  alarm(120);  // Ends this process when its test was killed and nobody else ends it.
  return spindrift::run(
      {.domain = static_cast<std::uint32_t>(std::stoul(argv[1])), .partition = argv[2]}, argv[3],
      std::stoull(argv[4]));
}
