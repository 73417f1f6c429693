#include <dds/dds.h>
#include <dds/ddsrt/log.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <set>

#include "services/bus/entity.h"
#include "services/bus/network.h"
#include "services/doctor/network.h"

namespace spindrift::doctor {
namespace {

// Limits Cyclone's trace to its configuration; the last of several sources takes precedence.
constexpr std::string_view kTraceConfiguration =
    ",<CycloneDDS><Domain Id=\"any\"><Tracing><Category>config</Category>"
    "<OutputFile>/dev/null</OutputFile></Tracing></Domain></CycloneDDS>";

/// Captures Cyclone's log and trace while it exists.
class TraceCapture {
 public:
  TraceCapture() {
    dds_set_log_sink(&append, &log_);
    dds_set_trace_sink(&append, &trace_);
  }
  ~TraceCapture() {
    dds_set_log_sink(nullptr, nullptr);
    dds_set_trace_sink(nullptr, nullptr);
  }
  TraceCapture(const TraceCapture&) = delete;
  TraceCapture& operator=(const TraceCapture&) = delete;
  TraceCapture(TraceCapture&&) = delete;
  TraceCapture& operator=(TraceCapture&&) = delete;

  const std::string& log() const { return log_; }
  const std::string& trace() const { return trace_; }

 private:
  static void append(void* text, const dds_log_data_t* entry) {
    static_cast<std::string*>(text)->append(entry->message);
  }

  std::string log_;
  std::string trace_;
};

/// Returns the text between `after` and `until`, or the end; empty where `after` is not found.
std::string_view between(std::string_view text, std::string_view after, std::string_view until) {
  const std::size_t found = text.find(after);
  if (found == std::string_view::npos) {
    return {};
  }
  text.remove_prefix(found + after.size());
  return text.substr(0, text.find(until));
}

std::string_view setting(std::string_view trace, const std::string& name) {
  return between(trace, fmt::format("config: Domain/{}: ", name), " {");
}

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} ? std::optional{value} : std::nullopt;
}

std::vector<std::string> peers_of(std::string_view trace) {
  static constexpr std::string_view kPeer = "Discovery/Peers/Peer[@Address]: ";
  std::vector<std::string> peers;
  for (auto at = trace.find(kPeer); at != std::string_view::npos; at = trace.find(kPeer)) {
    peers.emplace_back(between(trace, kPeer, " {"));
    trace.remove_prefix(at + kPeer.size());
  }
  return peers;
}

/// Returns the names in "lo (index 1 priority 0), eth0 (...)" without the brackets.
std::string interfaces_of(std::string_view trace) {
  std::string_view chosen = between(trace, "selected interfaces: ", "\n");
  std::string interfaces;
  while (!chosen.empty()) {
    interfaces += chosen.substr(0, chosen.find(" ("));
    chosen.remove_prefix(std::min(chosen.find(')'), chosen.size() - 1) + 1);
  }
  return interfaces;
}

std::string text_of(const char* path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

}  // namespace

NetworkSettings settings_of(std::string_view trace) {
  NetworkSettings settings{.interfaces = interfaces_of(trace),
                           .multicast = std::string{setting(trace, "General/AllowMulticast/#text")},
                           .peers = peers_of(trace),
                           .indices = {},
                           .receive_buffer_bytes = whole_number(
                               between(trace, "socket receive buffer size set to ", " "))};
  if (setting(trace, "Discovery/ParticipantIndex/#text") == "auto") {
    // Cyclone 0.10.2 assigns only indices below the "maximum".
    const auto count = whole_number(setting(trace, "Discovery/MaxAutoParticipantIndex/#text"));
    settings.indices = static_cast<int>(count.value_or(0));
  }
  const auto port_setting = [&](const std::string& name) {
    return whole_number(setting(trace, fmt::format("Discovery/{}/#text", name))).value_or(0);
  };
  settings.port_step = static_cast<std::uint16_t>(port_setting("Ports/ParticipantGain"));
  settings.first_port = static_cast<std::uint16_t>(port_setting("Ports/Base") +
                                                   port_setting("Ports/DomainGain") *
                                                       port_setting("ExternalDomainId") +
                                                   port_setting("Ports/UnicastMetaOffset"));
  return settings;
}

int free_indices(const NetworkSettings& settings, std::string_view udp_table) {
  std::set<int> ports;
  for (auto line = udp_table.find('\n'); line != std::string_view::npos;
       line = udp_table.find('\n', line + 1)) {
    // A line is "  sl: ADDRESS:PORT ...", both in hexadecimal.
    const std::string_view rest = udp_table.substr(line + 1);
    const std::string_view local = between(between(rest, ": ", "\n"), ":", " ");
    int port = 0;
    std::from_chars(local.data(), local.data() + local.size(), port, 16);
    ports.insert(port);
  }
  int free = 0;
  for (int index = 0; index < settings.indices.value_or(0); ++index) {
    const int port = settings.first_port + index * settings.port_step;
    free += ports.contains(port) || ports.contains(port + 1) ? 0 : 1;
  }
  return free;
}

NetworkFacts network_facts(std::uint32_t domain) {
  const bus::NetworkConfiguration network = bus::network_configuration();
  NetworkFacts facts{.domain = domain,
                     .configuration = network.name,
                     .settings = NetworkSettings{},
                     .free_indices = {}};
  const TraceCapture capture;
  {
    const auto created = bus::Entity::own(
        dds_create_domain(domain, (network.text + std::string{kTraceConfiguration}).c_str()),
        fmt::format("DDS domain {}", domain));
    if (!created) {
      facts.settings = Unexpected{
          {created.error().code, fmt::format("{}: {}", created.error().message, capture.log())}};
      return facts;
    }
    facts.settings = settings_of(capture.trace());
  }
  // Read after the domain has released its own ports.
  if (const std::string table = text_of("/proc/net/udp");
      !table.empty() && facts.settings->indices) {
    facts.free_indices = free_indices(*facts.settings, table);
  }
  return facts;
}

}  // namespace spindrift::doctor
