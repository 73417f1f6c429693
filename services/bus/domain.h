/// @file
/// A DDS domain of this process, created with our network configuration.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "pipelines/core/expected.h"

namespace spindrift::bus {

/// Highest id in DDS. The UDP ports of a domain follow from its id; see deploy/README.md.
inline constexpr std::uint32_t kMaxDomainId = 230;

/// A process can create a domain only once, so all members share it; the last one deletes it.
class Domain {
 public:
  /// @return InvalidConfiguration for an id above kMaxDomainId; Unavailable with Cyclone's message
  ///         when it refuses the network configuration or cannot open its sockets.
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
