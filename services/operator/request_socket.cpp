#include "services/operator/request_socket.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <iterator>
#include <system_error>
#include <utility>

#include "pipelines/core/shown.h"
#include "services/base/json_line.h"
#include "services/base/parsed_json.h"

namespace spindrift {

Descriptor::Descriptor(Descriptor&& other) noexcept : number_{std::exchange(other.number_, -1)} {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

Descriptor::~Descriptor() {
  if (is_open()) {
    ::close(number_);
  }
}

std::filesystem::path socket_of(const std::filesystem::path& archive) {
  std::error_code unresolved;
  auto real = std::filesystem::absolute(archive, unresolved);
  if (!unresolved) {
    real = std::filesystem::weakly_canonical(real, unresolved);
  }
  return (unresolved ? archive : real).string() + ".sock";
}

Expected<SocketAddress> address_of(const std::filesystem::path& socket) {
  SocketAddress address{
      .folder = Descriptor{::open(socket.parent_path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)},
      .name = {}};
  if (!address.folder.is_open()) {
    return socket_failure("no folder of", socket);
  }
  const std::string name =
      fmt::format("/proc/self/fd/{}/{}", address.folder.number(), socket.filename().string());
  if (name.size() >= std::size(address.name.sun_path)) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{}: the name of a local socket may have some 80 bytes",
                                   shown(socket.string()))}};
  }
  address.name.sun_family = AF_UNIX;
  std::copy(name.begin(), name.end(), std::begin(address.name.sun_path));
  return address;
}

Expected<void> send_all(const Descriptor& to, std::string_view text,
                        std::chrono::steady_clock::time_point until) {
  while (!text.empty()) {
    if (std::chrono::steady_clock::now() > until) {
      return Unexpected{{ErrorCode::Unavailable, "local socket: the caller reads too slowly"}};
    }
    const ssize_t sent = ::send(to.number(), text.data(), text.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno != EINTR) {
      return socket_failure("sending over", "local socket");
    }
    text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(sent, 0)));
  }
  return {};
}

Expected<std::string> receive_line(const Descriptor& from) {
  std::string line;
  std::array<char, 4096> part{};
  while (true) {
    const ssize_t now = ::recv(from.number(), part.data(), part.size(), 0);
    if (now < 0 && errno == EINTR) {
      continue;
    }
    if (now < 0) {
      return socket_failure("receiving over", "local socket");
    }
    line.append(part.data(), static_cast<std::size_t>(now));
    if (const auto end = line.find('\n'); end != std::string::npos) {
      line.resize(end);
      return line;
    }
    if (now == 0) {
      return Unexpected{{ErrorCode::Unavailable, "local socket: closed before an end of line"}};
    }
  }
}

Unexpected socket_failure(std::string_view what, const std::filesystem::path& socket) {
  return Unexpected{{ErrorCode::Unavailable, fmt::format("{} {}: {}", what, shown(socket.string()),
                                                         std::generic_category().message(errno))}};
}

Expected<std::optional<nlohmann::json>> ask_holder(const std::filesystem::path& archive,
                                                   const nlohmann::json& request) {
  const std::filesystem::path path = socket_of(archive);
  std::error_code unknown;  // Opening the archive reports a bad path.
  if (!std::filesystem::exists(path, unknown)) {
    return std::nullopt;
  }
  const auto address = address_of(path);
  if (!address) {
    return Unexpected{address.error()};
  }
  const Descriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  if (::connect(socket.number(), reinterpret_cast<const sockaddr*>(&address->name),
                sizeof(address->name)) != 0) {
    if (errno == ECONNREFUSED || errno == ENOENT) {
      return std::nullopt;
    }
    return socket_failure("connecting to", path);
  }
  return send_all(socket, json_line(request))
      .and_then([&] { return receive_line(socket); })
      .and_then([](const std::string& line) -> Expected<std::optional<nlohmann::json>> {
        auto answer = parsed_json(line);
        if (answer.is_discarded()) {
          return Unexpected{{ErrorCode::Unavailable, "local socket: no JSON"}};
        }
        return answer;
      });
}

}  // namespace spindrift
