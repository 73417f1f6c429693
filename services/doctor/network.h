/// @file
/// Checks the network configuration of Cyclone DDS, and whether a sample passes through it.

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

/// Cyclone's effective configuration, defaults included.
struct NetworkSettings {
  std::string interfaces;  ///< Interfaces that Cyclone selected.
  std::string multicast;   ///< AllowMulticast: "false", "true", "spdp", ...
  std::vector<std::string> peers;
  /// Number of programs that the domain allows on a host; empty when participants are not numbered,
  /// which requires multicast.
  std::optional<int> indices;
  std::uint16_t first_port = 0;                      ///< Port of index 0.
  std::uint16_t port_step = 0;                       ///< Distance between indices.
  std::optional<std::int64_t> receive_buffer_bytes;  ///< As granted by the kernel.
};

/// Parses the trace that Cyclone writes when it creates a domain. Missing values are empty or 0.
NetworkSettings settings_of(std::string_view trace);

/// Counts the indices without a UDP port in use.
/// @param udp_table Text of /proc/net/udp.
int free_indices(const NetworkSettings& settings, std::string_view udp_table);

struct NetworkFacts {
  std::uint32_t domain;
  std::string configuration;           ///< Source of the configuration.
  Expected<NetworkSettings> settings;  ///< Unavailable with Cyclone's message on refusal.
  std::optional<int> free_indices;
};

/// Creates the domain briefly; call it before this process joins the domain.
NetworkFacts network_facts(std::uint32_t domain);

std::vector<Check> check_network(const NetworkFacts& facts);

/// Result of sending one sample from another process to this one.
struct RoundTrip {
  Expected<double> duration_ms;  ///< From the first announcement to the sample.
  pid_t partner;                 ///< Process id of the sender, which has ended.
};

/// Forks, so that the sample passes through the network and not through memory; call it before any
/// thread is started. It uses a partition of its own.
RoundTrip round_trip(std::uint32_t domain);

Check check_round_trip(const Expected<double>& duration_ms);

}  // namespace spindrift::doctor
