#include "services/bus/domain.h"

#include <dds/ddsrt/log.h>
#include <fmt/format.h>

#include <cstdio>
#include <map>
#include <mutex>

#include "services/bus/cyclone_log.h"
#include "services/bus/entity.h"
#include "services/bus/network.h"

namespace spindrift::bus {
namespace {

struct SharedDomain {
  Entity entity;
  int members;
};

/// Counts the members of this process's domains, since Cyclone refuses to create one twice.
struct Registry {
  std::mutex mutex;
  std::map<std::uint32_t, SharedDomain> domains;
};

Registry& registry() {
  static Registry instance;
  return instance;
}

/// Captures Cyclone's log while it exists, since Cyclone explains failures only there.
class LogCapture {
 public:
  LogCapture() { dds_set_log_sink(&append, &text_); }
  ~LogCapture() { log_what_cyclone_says(); }
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;
  LogCapture(LogCapture&&) = delete;
  LogCapture& operator=(LogCapture&&) = delete;

  const std::string& text() const { return text_; }

 private:
  static void append(void* text, const dds_log_data_t* entry) {
    static_cast<std::string*>(text)->append(entry->message);
  }

  std::string text_;
};

Expected<Entity> create_domain(std::uint32_t id, const NetworkConfiguration& network) {
  const LogCapture log;
  auto domain = Entity::own(dds_create_domain(id, network.text.c_str()),
                            fmt::format("DDS domain {} with {}", id, network.name));
  if (!domain) {
    return Unexpected{
        Error{domain.error().code, fmt::format("{}: {}", domain.error().message, log.text())}};
  }
  // Warnings about a working domain are printed as usual.
  static_cast<void>(std::fputs(log.text().c_str(), stderr));
  return domain;
}

bool lacks_index(const Expected<Entity>& domain) {
  return !domain && domain.error().message.find("participant index") != std::string::npos;
}

/// Creates the domain with the configured indices, or where other programs have taken all of these,
/// with one of all for which a domain has ports. A program with such an index finds the others, and
/// so they find it.
Expected<Entity> create_domain(std::uint32_t id) {
  NetworkConfiguration network = network_configuration();
  auto domain = create_domain(id, network);
  if (lacks_index(domain)) {
    network.text +=
        ",<CycloneDDS><Domain><Discovery><MaxAutoParticipantIndex>120</MaxAutoParticipantIndex>"
        "</Discovery></Domain></CycloneDDS>";
    domain = create_domain(id, network);
  }
  if (lacks_index(domain)) {
    return Unexpected{Error{domain.error().code,
                            domain.error().message +
                                ": 120 programs of this host are in the domain, for more there are "
                                "no ports: end some of them, or use another domain (--domain)"}};
  }
  return domain;
}

}  // namespace

Expected<Domain> Domain::join(std::uint32_t id) {
  if (id > kMaxDomainId) {
    return Unexpected{Error{ErrorCode::InvalidConfiguration,
                            fmt::format("DDS domain {}: must be 0 to {}", id, kMaxDomainId)}};
  }
  const std::lock_guard lock{registry().mutex};
  auto& domains = registry().domains;
  if (const auto known = domains.find(id); known != domains.end()) {
    ++known->second.members;
    return Domain{id};
  }
  auto created = create_domain(id);
  if (!created) {
    return Unexpected{created.error()};
  }
  domains.emplace(id, SharedDomain{.entity = std::move(*created), .members = 1});
  return Domain{id};
}

Domain::~Domain() {
  if (!id_) {
    return;
  }
  const std::lock_guard lock{registry().mutex};
  const auto joined = registry().domains.find(*id_);
  if (--joined->second.members == 0) {
    registry().domains.erase(joined);
  }
}

}  // namespace spindrift::bus
