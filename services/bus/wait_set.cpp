#include "services/bus/wait_set.h"

namespace spindrift::bus {

Expected<WaitSet> WaitSet::create(const Participant& participant) {
  auto set = Entity::own(dds_create_waitset(participant.handle()), "DDS waitset");
  if (!set) {
    return Unexpected{set.error()};
  }
  auto guard = Entity::own(dds_create_guardcondition(participant.handle()), "DDS guard condition");
  if (!guard) {
    return Unexpected{guard.error()};
  }
  WaitSet created{std::move(*set), std::move(*guard)};
  return created.attach(created.guard_).map([&created] { return std::move(created); });
}

Expected<void> WaitSet::attach(const Entity& condition) {
  const dds_return_t result =
      dds_waitset_attach(set_.handle(), condition.handle(), condition.handle());
  if (result < 0) {
    return Unexpected{dds_error("attaching a condition to a DDS waitset", result)};
  }
  return {};
}

Expected<bool> WaitSet::wait(std::chrono::nanoseconds at_most) const {
  const dds_return_t result = dds_waitset_wait(set_.handle(), nullptr, 0, at_most.count());
  if (result < 0) {
    return Unexpected{dds_error("waiting on a DDS waitset", result)};
  }
  bool stopped = false;
  const dds_return_t read = dds_read_guardcondition(guard_.handle(), &stopped);
  if (read < 0) {
    return Unexpected{dds_error("reading a DDS guard condition", read)};
  }
  return !stopped;
}

void WaitSet::stop() const {
  // Fails only if the participant was deleted first, which has also ended every wait.
  static_cast<void>(dds_set_guardcondition(guard_.handle(), true));
}

}  // namespace spindrift::bus
