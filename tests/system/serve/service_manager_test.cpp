// Notifications of `serve` to systemd, received on a datagram socket.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <string>

namespace spindrift::service_manager_test {

class Manager {
 public:
  explicit Manager(const std::filesystem::path& path)
      : socket_{::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)} {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Manager() { ::close(socket_); }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  /// Waits for a notification that contains `word`.
  bool hears(const std::string& word) {
    return eventually([&] {
      std::array<char, 256> message{};
      while (::recv(socket_, message.data(), message.size() - 1, 0) > 0) {
        heard_ += message.data();
        heard_ += "\n";
        message = {};
      }
      return heard_.find(word) != std::string::npos;
    });
  }

 private:
  int socket_;
  std::string heard_;
};

TEST(ServiceManager, HearsThatTheServiceIsReadyLivesAndStops) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "notify";
  Manager manager{path};
  Program service{"/usr/bin/env",
                  on(bus_of_its_own(),
                     {"NOTIFY_SOCKET=" + path.string(), spindrift_program(), "serve", "--mission",
                      kPasses / "nominal" / "mission.toml", "--db", folder.path() / "served.db"})};
  EXPECT_TRUE(manager.hears("READY=1")) << service.log();
  EXPECT_TRUE(manager.hears("WATCHDOG=1")) << service.log();
  service.signal(SIGTERM);
  EXPECT_TRUE(manager.hears("STOPPING=1")) << service.log();
  EXPECT_EQ(service.exit_status(), 0);
}

}  // namespace spindrift::service_manager_test
