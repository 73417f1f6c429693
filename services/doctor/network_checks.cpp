#include <fmt/format.h>
#include <fmt/ranges.h>

#include "services/doctor/network.h"

namespace spindrift::doctor {
namespace {

// With fewer indices, other programs of a pass (front-end, displays, replay) may not fit.
constexpr int kFewIndices = 4;
// Default request of Cyclone DDS 0.10 to the kernel.
constexpr std::int64_t kReceiveBuffer_bytes = 1'048'576;
constexpr double kSlowRoundTrip_ms = 1000.0;

std::string description(const NetworkFacts& facts) {
  const NetworkSettings& settings = *facts.settings;
  return fmt::format(
      "domain {}, {}\ninterfaces: {}; multicast: {}; peers: {}", facts.domain, facts.configuration,
      settings.interfaces, settings.multicast,
      settings.peers.empty() ? "none" : fmt::format("{}", fmt::join(settings.peers, ", ")));
}

Check check_configuration(const NetworkFacts& facts) {
  const NetworkSettings& settings = *facts.settings;
  if (settings.multicast == "false" && settings.peers.empty()) {
    return warning("network", description(facts),
                   "without multicast nobody is found unless Discovery/Peers names the hosts");
  }
  return ok("network", description(facts));
}

Check check_indices(const NetworkFacts& facts) {
  const std::string name = "participants";
  const auto& indices = facts.settings->indices;
  if (!indices) {
    return ok(name, "not numbered: any number of programs may join on this host");
  }
  if (!facts.free_indices) {
    return ok(name, fmt::format("{} programs may join on this host", *indices));
  }
  const std::string found =
      fmt::format("{} of {} programs may still join on this host", *facts.free_indices, *indices);
  return *facts.free_indices < kFewIndices
             ? warning(name, found,
                       "raise Discovery/MaxAutoParticipantIndex in the network configuration of "
                       "every program, or end programs that are no longer needed")
             : ok(name, found);
}

Check check_receive_buffer(std::int64_t granted_bytes) {
  const std::string found = fmt::format("{} KiB for each socket", granted_bytes / 1024);
  return granted_bytes < kReceiveBuffer_bytes
             ? warning("receive buffer", found,
                       "bursts will be lost and sent again: sysctl -w net.core.rmem_max=8388608")
             : ok("receive buffer", found);
}

}  // namespace

std::vector<Check> check_network(const NetworkFacts& facts) {
  if (!facts.settings) {
    return {failure("network",
                    fmt::format("domain {}, {}: {}", facts.domain, facts.configuration,
                                facts.settings.error().message),
                    "correct the configuration named, free a participant index, or unset "
                    "CYCLONEDDS_URI for the built-in one")};
  }
  std::vector<Check> checks{check_configuration(facts), check_indices(facts)};
  if (const auto& granted = facts.settings->receive_buffer_bytes) {
    checks.push_back(check_receive_buffer(*granted));
  }
  return checks;
}

Check check_round_trip(const Expected<double>& duration_ms) {
  const std::string name = "round trip";
  if (!duration_ms) {
    return failure(name, duration_ms.error().message,
                   "look for a firewall on the interface, or for another configuration of the "
                   "network than the one above");
  }
  const std::string found = fmt::format(
      "a sample came from another process after {:.0f} ms, discovery included", *duration_ms);
  return *duration_ms > kSlowRoundTrip_ms
             ? warning(name, found, "the host is busy: see what else runs on it")
             : ok(name, found);
}

}  // namespace spindrift::doctor
