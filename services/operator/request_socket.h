/// @file
/// A local socket in the file system, and lines over it.

#pragma once

#include <sys/un.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"

namespace spindrift {

/// A file descriptor that is closed with it.
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

/// Of the archive, whichever link it is reached by.
std::filesystem::path socket_of(const std::filesystem::path& archive);

/// What the kernel calls a socket of that path, and the folder that must stay open meanwhile.
struct SocketAddress {
  Descriptor folder;
  sockaddr_un name;
};
/// @return InvalidConfiguration where the name of the file is too long; Unavailable where there is
///         no such folder.
Expected<SocketAddress> address_of(const std::filesystem::path& socket);

/// @return Unavailable when the other side is gone.
Expected<void> send_all(const Descriptor& to, std::string_view text);
/// Without its line end. @param most Bytes; 0: any number. @return Unavailable when the other side
/// is gone, silent for too long (SO_RCVTIMEO), or says more.
Expected<std::string> receive_line(const Descriptor& from, std::size_t most);

/// With what errno says.
Unexpected socket_failure(std::string_view what, const std::filesystem::path& socket);

}  // namespace spindrift
