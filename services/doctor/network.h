/// @file
/// The network as Cyclone DDS takes it, and whether a sample passes through it.

#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/bus/participant.h"
#include "services/doctor/check.h"

namespace spindrift::doctor {

/// What Cyclone made of its configuration, defaults included.
struct NetworkSettings {
  std::string interfaces;  ///< Those chosen.
  std::string multicast;   ///< Of AllowMulticast: "false", "true", "spdp", ...
  std::vector<std::string> peers;
  /// Programs that a host can run in the domain; absent where they are not numbered, which only
  /// multicast allows.
  std::optional<int> indices;
  std::uint16_t first_port = 0;                      ///< Of index 0.
  std::uint16_t port_step = 0;                       ///< From an index to the next.
  std::optional<std::int64_t> receive_buffer_bytes;  ///< As the kernel granted it.
};

/// From the trace that Cyclone writes when a domain is created. What it does not say is empty or 0.
NetworkSettings settings_of(std::string_view trace);

/// How many of the indices have no UDP port in use.
/// @param udp_table As /proc/net/udp gives it.
int free_indices(const NetworkSettings& settings, std::string_view udp_table);

struct NetworkFacts {
  std::uint32_t domain;
  std::string configuration;           ///< Where it came from.
  Expected<NetworkSettings> settings;  ///< Unavailable, in Cyclone's words, when it refuses.
  std::optional<int> free_indices;
};

/// Creates the domain for a moment; before anything else of this process joins it.
NetworkFacts network_facts(std::uint32_t domain);

std::vector<Check> check_network(const NetworkFacts& facts);

/// One sample from another process to this one.
struct RoundTrip {
  Expected<double> duration_ms;  ///< From the first announcement to the sample.
  pid_t partner;                 ///< Gone by now.
};

/// Forks, so that the sample goes through the network and not through memory: call it before any
/// thread is started. Uses a partition of its own.
RoundTrip round_trip(std::uint32_t domain);

Check check_round_trip(const Expected<double>& duration_ms);

}  // namespace spindrift::doctor
