/// @file
/// A DDS domain and partition of its own for each test.

#pragma once

#include <netinet/in.h>
#include <spindrift.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <numeric>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "services/bus/participant.h"
#include "services/bus/reader.h"
#include "services/bus/telemetry_messages.h"
#include "services/bus/writer.h"
#include "tests/support/eventually.h"

namespace spindrift {

/// Returns the domains that have a UDP socket on this machine. Domain N uses the 250 UDP ports from
/// 7400 + 250 N on. Those of domains 20 to 99 lie above the usual domains and below the ephemeral
/// ports.
inline std::set<unsigned> domains_in_use() {
  std::set<unsigned> used;
  for (const char* sockets : {"/proc/net/udp", "/proc/net/udp6"}) {
    std::ifstream lines{sockets};
    std::string slot;
    std::string address;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream{line} >> slot >> address;
      if (const auto colon = address.find(':'); colon != std::string::npos) {
        used.insert(
            (static_cast<unsigned>(std::stoul(address.substr(colon + 1), nullptr, 16)) - 7400U) /
            250U);
      }
    }
  }
  return used;
}

/// Reserves a domain until this process ends by binding its last port, which no participant uses.
/// @return False if another process has the port.
inline bool is_reserved(unsigned domain) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(7400U + 250U * domain + 249U));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    return true;
  }
  ::close(socket);
  return false;
}

/// Returns a domain that nobody uses, with another partition for each call.
inline bus::BusConfig bus_of_its_own() {
  constexpr unsigned kFirst = 20;
  constexpr unsigned kDomains = 80;
  static int calls = 0;
  const auto used = domains_in_use();
  const auto pid = static_cast<unsigned>(getpid());
  unsigned tried = 0;
  while (tried < kDomains && (used.contains(kFirst + (pid + tried) % kDomains) ||
                              !is_reserved(kFirst + (pid + tried) % kDomains))) {
    ++tried;
  }
  return {.domain = kFirst + (pid + tried) % kDomains,
          .partition = "test-" + std::to_string(pid) + "-" + std::to_string(++calls)};
}

/// Returns a reader of telemetry of one kind.
template <class Value>
bus::Reader<bus::MessageOf<Value>> telemetry_reader(
    const bus::Participant& participant, const bus::Qos& qos = bus::telemetry_reader_qos()) {
  return bus::Reader<bus::MessageOf<Value>>::create(participant, bus::topic_of<Value>(), qos)
      .value();
}

/// Returns a writer of telemetry of one kind.
template <class Value>
bus::Writer<bus::MessageOf<Value>> telemetry_writer(
    const bus::Participant& participant, const bus::Qos& qos = bus::telemetry_writer_qos()) {
  return bus::Writer<bus::MessageOf<Value>>::create(participant, bus::topic_of<Value>(), qos)
      .value();
}

/// Takes samples until there are `count`, or the wait of eventually() is over.
template <class Sample>
std::vector<Sample> take_samples(const bus::Reader<Sample>& reader, std::size_t count) {
  std::vector<Sample> samples;
  eventually([&] {
    reader.take([&samples](const Sample& sample) { samples.push_back(sample); }).value();
    return samples.size() >= count;
  });
  return samples;
}

inline std::vector<std::uint64_t> seqs_of(const std::vector<spindrift_Pulse>& pulses) {
  std::vector<std::uint64_t> seqs;
  seqs.reserve(pulses.size());
  for (const spindrift_Pulse& pulse : pulses) {
    seqs.push_back(pulse.seq);
  }
  return seqs;
}

/// Returns 0, 1, 2, ..., `count` - 1.
inline std::vector<std::uint64_t> first_seqs(std::size_t count) {
  std::vector<std::uint64_t> seqs(count);
  std::iota(seqs.begin(), seqs.end(), 0U);
  return seqs;
}

/// 2026-11-20T03:00:00 UTC.
inline constexpr std::int64_t kTestTime_tai_ns = 1'795'143'637'000'000'000;

inline spindrift_Pulse idl_pulse(std::uint64_t seq, std::uint64_t session = 1) {
  return {.spacecraft = "SPINNER",
          .source = "front-end",
          .session = session,
          .seq = seq,
          .t_tai_ns = kTestTime_tai_ns + static_cast<std::int64_t>(seq) * 1'000'000'000,
          .channel = spindrift_SUN1};
}

/// Writes idl_pulse() of the first sequence numbers.
/// @return False if one is refused.
inline bool write_pulses(const bus::Writer<spindrift_Pulse>& writer, std::uint64_t count) {
  bool written = true;
  for (std::uint64_t seq = 0; seq < count && written; ++seq) {
    written = writer.write(idl_pulse(seq)).has_value();
  }
  return written;
}

inline spindrift_CodedFrame idl_frame(std::uint64_t seq) {
  return {.spacecraft = "SPINNER",
          .source = "front-end",
          .session = 1,
          .seq = seq,
          .t_tai_ns = kTestTime_tai_ns + static_cast<std::int64_t>(seq) * 1'000'000'000,
          .period_s = 1.0,
          .sun2_s = 0.125,
          .north_in_s = 0.25,
          .north_out_s = 0.375,
          .south_in_s = 0.5,
          .south_out_s = 0.625};
}

}  // namespace spindrift
