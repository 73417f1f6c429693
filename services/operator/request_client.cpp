#include "services/operator/request_client.h"

#include <sys/socket.h>

#include <cerrno>
#include <system_error>

#include "services/base/json_line.h"
#include "services/operator/request_socket.h"

namespace spindrift {

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
      .and_then([&] { return receive_line(socket, 0); })
      .and_then([](const std::string& line) -> Expected<std::optional<nlohmann::json>> {
        auto answer = nlohmann::json::parse(line, nullptr, false);
        if (answer.is_discarded()) {
          return Unexpected{{ErrorCode::Unavailable, "local socket: no JSON"}};
        }
        return answer;
      });
}

}  // namespace spindrift
