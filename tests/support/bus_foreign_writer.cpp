/// @file
/// bus_foreign_writer DOMAIN PARTITION telemetry|weak COUNT: pulses from another process.

#include <cstdlib>
#include <iostream>
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

Expected<void> write_all(const bus::Writer<spindrift_Pulse>& writer, std::uint64_t count) {
  auto written = writer.wait_for_reader(30s);
  for (std::uint64_t seq = 0; seq < count && written; ++seq) {
    written = writer.write(idl_pulse(seq), std::stop_token{});
  }
  return written.and_then([&writer] { return writer.wait_for_acknowledgments(30s); });
}

int run(const bus::BusConfig& config, bool weak, std::uint64_t count) {
  const auto participant = bus::Participant::create(config);
  const auto writer = bus::Writer<spindrift_Pulse>::create(
      participant.value(), bus::topic_of<Pulse>(), weak ? weak_qos() : bus::telemetry_writer_qos());
  if (weak) {
    std::this_thread::sleep_for(60s);
    return EXIT_FAILURE;
  }
  const auto written = write_all(writer.value(), count);
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
  alarm(120);  // Nobody waits for it longer, nor kills it once its test is killed.
  return spindrift::run(
      {.domain = static_cast<std::uint32_t>(std::stoul(argv[1])), .partition = argv[2]},
      std::string{argv[3]} == "weak", std::stoull(argv[4]));
}
