/// @file
/// A local socket in the file system, the exchange of lines over it, and the side that asks.
///
/// The kernel takes paths of at most 107 bytes. The folder is therefore opened, and the socket is
/// named by the folder's descriptor. Nobody answers on the socket of a killed program. The caller
/// then does the work itself, and the next holder of the archive removes the socket.

#pragma once

#include <sys/un.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Owns a file descriptor and closes it.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_{number} {}
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor();

  int number() const { return number_; }
  bool is_open() const { return number_ >= 0; }

 private:
  int number_;
};

/// Returns the socket path of an archive, the same for every link to it.
std::filesystem::path socket_of(const std::filesystem::path& archive);

/// The kernel's name of a socket path, with the folder that must stay open while it is used.
struct SocketAddress {
  Descriptor folder;
  sockaddr_un name;
};
/// @return InvalidConfiguration when the file name is too long; Unavailable when the folder does
///         not exist.
Expected<SocketAddress> address_of(const std::filesystem::path& socket);

/// @param until Time after which no further part is sent. @return Unavailable when the other side
/// has closed or takes too long.
Expected<void> send_all(
    const Descriptor& to, std::string_view text,
    std::chrono::steady_clock::time_point until = std::chrono::steady_clock::time_point::max());
/// Returns a line without its end. @return Unavailable when the other side has closed.
Expected<std::string> receive_line(const Descriptor& from);

/// Makes an error with the text for errno.
Unexpected socket_failure(std::string_view what, const std::filesystem::path& socket);

/// Sends a request to the program that holds an archive and waits for the answer. @return Empty
/// when no program holds the archive; Unavailable when the holder fails while answering.
Expected<std::optional<nlohmann::json>> ask_holder(const std::filesystem::path& archive,
                                                   const nlohmann::json& request);

}  // namespace spindrift
