#include "services/bus/entity.h"

#include <fmt/format.h>

namespace spindrift::bus {

Error dds_error(std::string_view what, dds_return_t result) {
  return {ErrorCode::Unavailable, fmt::format("{}: {}", what, dds_strretcode(result))};
}

Expected<Entity> Entity::own(dds_entity_t created, std::string_view what) {
  if (created < 0) {
    return Unexpected{dds_error(what, created)};
  }
  return Entity{created};
}

void Entity::destroy() const {
  if (handle_ > 0) {
    // Fails only when the parent was deleted first, together with this entity.
    static_cast<void>(dds_delete(handle_));
  }
}

}  // namespace spindrift::bus
