#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <set>

#include "pipelines/core/shown.h"
#include "services/doctor/presence.h"
#include "services/telemetry/telemetry_kinds.h"

namespace spindrift::doctor {
namespace {

bool in_partition(const Endpoint& endpoint, const std::string& partition) {
  return std::any_of(endpoint.partitions.begin(), endpoint.partitions.end(),
                     [&](const std::string& name) {
                       return fnmatch(name.c_str(), partition.c_str(), 0) == 0 ||
                              fnmatch(partition.c_str(), name.c_str(), 0) == 0;
                     });
}

std::string lines(const std::set<std::string>& texts) {
  return fmt::format("{}", fmt::join(texts, "\n"));
}

/// Returns for example "spindrift/pulse written by ..., partition 'live'".
std::string description(const Endpoint& endpoint) {
  return fmt::format("{} {} by {}, partition '{}'", shown(endpoint.topic),
                     endpoint.writes ? "written" : "read", endpoint.owner,
                     shown(fmt::format("{}", fmt::join(endpoint.partitions, "', '"))));
}

std::string listed(const std::vector<bus::Shortfall>& shortfalls,
                   std::string bus::Shortfall::*side) {
  std::vector<std::string> texts;
  texts.reserve(shortfalls.size());
  for (const bus::Shortfall& shortfall : shortfalls) {
    texts.push_back(shortfall.*side);
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string mismatch(const Endpoint& endpoint) {
  const std::string offered = listed(endpoint.shortfalls, &bus::Shortfall::offered);
  const std::string needed = listed(endpoint.shortfalls, &bus::Shortfall::needed);
  return endpoint.writes ? fmt::format("{}: offers {}, spindrift needs {}", description(endpoint),
                                       offered, needed)
                         : fmt::format("{}: asks for {}, spindrift offers {}",
                                       description(endpoint), needed, offered);
}

bool is_telemetry(const Endpoint& endpoint) {
  bool is_topic = false;
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    is_topic = is_topic || endpoint.topic == Telemetry<Value>::kTopic;
  });
  return endpoint.writes && is_topic;
}

Check check_company(const PresenceFacts& facts) {
  std::set<std::string> texts(facts.participants.begin(), facts.participants.end());
  for (const Endpoint& endpoint : facts.endpoints) {
    texts.insert("  " + description(endpoint));
  }
  return ok("programs on the bus", texts.empty() ? "none but this one" : lines(texts));
}

Check check_telemetry(const PresenceFacts& facts) {
  std::set<std::string> here;
  std::set<std::string> elsewhere;
  for (const Endpoint& endpoint : facts.endpoints) {
    if (is_telemetry(endpoint)) {
      (in_partition(endpoint, facts.bus.partition) ? here : elsewhere)
          .insert(description(endpoint));
    }
  }
  if (!here.empty()) {
    return ok("telemetry", lines(here));
  }
  const std::string found = fmt::format("nobody publishes telemetry in domain {}, partition '{}'",
                                        facts.bus.domain, facts.bus.partition);
  return elsewhere.empty()
             ? warning("telemetry", found,
                       "start the front-end; if it runs, give it this domain and the network "
                       "configuration above")
             : warning("telemetry", fmt::format("{}, but elsewhere:\n{}", found, lines(elsewhere)),
                       "give the front-end this partition, or the service the front-end's with "
                       "--partition");
}

Check check_qos(const PresenceFacts& facts) {
  std::set<std::string> mismatches;
  for (const Endpoint& endpoint : facts.endpoints) {
    if (!endpoint.shortfalls.empty() && in_partition(endpoint, facts.bus.partition)) {
      mismatches.insert(mismatch(endpoint));
    }
  }
  return mismatches.empty()
             ? ok("QoS", fmt::format("no mismatch in partition '{}'", facts.bus.partition))
             : failure("QoS", lines(mismatches),
                       "these never exchange a sample: change the QoS of the program named");
}

}  // namespace

std::vector<Check> check_presence(const PresenceFacts& facts) {
  return {check_company(facts), check_telemetry(facts), check_qos(facts)};
}

}  // namespace spindrift::doctor
