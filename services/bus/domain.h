/// @file
/// A DDS domain of this process, created with our network configuration.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "pipelines/core/expected.h"

namespace spindrift::bus {

/// DDS knows no higher one. The UDP ports of a domain follow from its number; see
/// deploy/cyclonedds/README.md.
inline constexpr std::uint32_t kMaxDomainId = 230;

/// Cyclone creates a domain once a process. All who join it here share it; it goes with the last.
class Domain {
 public:
  /// @return InvalidConfiguration for an id above kMaxDomainId, Unavailable with Cyclone's own
  /// words when it refuses the network configuration or cannot open its sockets.
  static Expected<Domain> join(std::uint32_t id);

  ~Domain();
  Domain(Domain&& other) noexcept : id_{std::exchange(other.id_, std::nullopt)} {}
  Domain& operator=(Domain&&) = delete;
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

 private:
  explicit Domain(std::uint32_t id) : id_{id} {}

  std::optional<std::uint32_t> id_;
};

}  // namespace spindrift::bus
