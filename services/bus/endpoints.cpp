#include "services/bus/endpoints.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "services/bus/builtin_topics.h"
#include "services/bus/policies.h"
#include "services/bus/qos.h"

namespace spindrift::bus {
namespace {

/// One of our endpoints, as seen by the other side.
struct OurEndpoint {
  std::string topic;
  std::string partition;
  Qos qos;
};

Expected<OurEndpoint> our_endpoint(const Entity& entity) {
  std::array<char, 256> topic{};
  OurEndpoint endpoint{.topic = {}, .partition = {}, .qos = Qos{dds_create_qos()}};
  const Qos parent_qos{dds_create_qos()};
  for (const dds_return_t result :
       {dds_get_name(dds_get_topic(entity.handle()), topic.data(), topic.size()),
        dds_get_qos(entity.handle(), endpoint.qos.get()),
        dds_get_qos(dds_get_parent(entity.handle()), parent_qos.get())}) {
    if (result < 0) {
      return Unexpected{dds_error("looking at a DDS endpoint of our own", result)};
    }
  }
  endpoint.topic = topic.data();
  endpoint.partition = partitions_of(parent_qos.get()).front();
  return endpoint;
}

/// DDS treats a partition name as a pattern.
bool share_partition(const OurEndpoint& ours, const dds_qos_t* theirs) {
  const auto names = partitions_of(theirs);
  return std::any_of(names.begin(), names.end(), [&ours](const std::string& name) {
    return fnmatch(name.c_str(), ours.partition.c_str(), 0) == 0 ||
           fnmatch(ours.partition.c_str(), name.c_str(), 0) == 0;
  });
}

/// Returns "process foo (pid 12) on host h", or only the GUID for other vendors' participants.
Expected<std::string> owner_of(const Entity& entity, const dds_guid_t& participant) {
  std::string owner = fmt::format("participant {:02x}", fmt::join(participant.v, ""));
  const auto describe = [&](const dds_builtintopic_participant_t& present) {
    if (std::memcmp(present.key.v, participant.v, sizeof participant.v) == 0) {
      owner = fmt::format("process {} (pid {}) on host {}", property(present.qos, "__ProcessName"),
                          property(present.qos, "__Pid"), property(present.qos, "__Hostname"));
    }
  };
  return for_each_present<dds_builtintopic_participant_t>(
             entity.handle(), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, describe)
      .map([&owner] { return owner; });
}

/// An endpoint on our topic and partition that does not match.
struct Mismatch {
  dds_guid_t participant;
  std::vector<Shortfall> shortfalls;
};

/// @param compare `compare(ours, theirs)` returns the shortfalls between two endpoints.
template <class Compare>
Expected<std::vector<Mismatch>> mismatches(const Entity& entity, const OurEndpoint& ours,
                                           dds_entity_t builtin_topic, const Compare& compare) {
  std::vector<Mismatch> found;
  const auto look_at = [&](const dds_builtintopic_endpoint_t& theirs) {
    if (ours.topic != theirs.topic_name || !share_partition(ours, theirs.qos)) {
      return;
    }
    if (auto missing = compare(ours.qos.get(), theirs.qos); !missing.empty()) {
      found.push_back({.participant = theirs.participant_key, .shortfalls = std::move(missing)});
    }
  };
  return for_each_present<dds_builtintopic_endpoint_t>(entity.handle(), builtin_topic, look_at)
      .map([&found] { return std::move(found); });
}

std::string listed(const std::vector<Shortfall>& shortfalls, std::string Shortfall::*side) {
  std::string text;
  for (const Shortfall& shortfall : shortfalls) {
    text += (text.empty() ? "" : ", ") + shortfall.*side;
  }
  return text;
}

}  // namespace

Expected<std::vector<std::string>> incompatible_writers(const Entity& reader) {
  const auto ours = our_endpoint(reader);
  if (!ours) {
    return Unexpected{ours.error()};
  }
  const auto found = mismatches(
      reader, *ours, DDS_BUILTIN_TOPIC_DCPSPUBLICATION,
      [](const dds_qos_t* our_qos, const dds_qos_t* offer) { return shortfalls(offer, our_qos); });
  if (!found) {
    return Unexpected{found.error()};
  }
  std::vector<std::string> sentences;
  for (const Mismatch& writer : *found) {
    const auto owner = owner_of(reader, writer.participant);
    if (!owner) {
      return Unexpected{owner.error()};
    }
    sentences.push_back(fmt::format("writer of {}, topic {}, offers {}; spindrift needs {}", *owner,
                                    ours->topic, listed(writer.shortfalls, &Shortfall::offered),
                                    listed(writer.shortfalls, &Shortfall::needed)));
  }
  return sentences;
}

Expected<std::vector<std::string>> incompatible_readers(const Entity& writer) {
  const auto ours = our_endpoint(writer);
  if (!ours) {
    return Unexpected{ours.error()};
  }
  const auto found = mismatches(
      writer, *ours, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION,
      [](const dds_qos_t* our_qos, const dds_qos_t* need) { return shortfalls(our_qos, need); });
  if (!found) {
    return Unexpected{found.error()};
  }
  std::vector<std::string> sentences;
  for (const Mismatch& reader : *found) {
    const auto owner = owner_of(writer, reader.participant);
    if (!owner) {
      return Unexpected{owner.error()};
    }
    sentences.push_back(fmt::format("reader of {}, topic {}, asks for {}; spindrift offers {}",
                                    *owner, ours->topic,
                                    listed(reader.shortfalls, &Shortfall::needed),
                                    listed(reader.shortfalls, &Shortfall::offered)));
  }
  return sentences;
}

}  // namespace spindrift::bus
