/// @file
/// Owns a Cyclone DDS entity, and converts return codes to errors.

#pragma once

#include <dds/dds.h>

#include <string_view>
#include <utility>

#include "pipelines/core/expected.h"

namespace spindrift::bus {

/// Returns Unavailable with "`what`: reason of Cyclone". @param result A negative return code.
Error dds_error(std::string_view what, dds_return_t result);

/// Owns an entity and deletes it.
class Entity {
 public:
  /// Takes the result of a `dds_create_*` call.
  /// @return Unavailable with `what` when the result is an error.
  static Expected<Entity> own(dds_entity_t created, std::string_view what);

  ~Entity() { destroy(); }
  Entity(Entity&& other) noexcept : handle_{std::exchange(other.handle_, 0)} {}
  Entity& operator=(Entity&& other) noexcept {
    if (this != &other) {
      destroy();
      handle_ = std::exchange(other.handle_, 0);
    }
    return *this;
  }
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;

  dds_entity_t handle() const { return handle_; }

 private:
  explicit Entity(dds_entity_t handle) : handle_{handle} {}
  void destroy() const;

  dds_entity_t handle_;
};

}  // namespace spindrift::bus
