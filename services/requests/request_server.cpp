#include "services/requests/request_server.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>

#include <array>
#include <exception>
#include <string>
#include <utility>

#include "services/standard_error/warning.h"
#include "services/words/json_line.h"

namespace spindrift {
namespace {

constexpr std::size_t kLongestRequest = 1 << 20;
constexpr timeval kUntilAsked{.tv_sec = 5, .tv_usec = 0};
constexpr int kCallersWaiting = 16;

}  // namespace

Expected<std::unique_ptr<RequestServer>> RequestServer::start(const std::filesystem::path& archive,
                                                              Answer answer) {
  const std::filesystem::path path = socket_of(archive);
  const auto address = address_of(path);
  if (!address) {
    return Unexpected{address.error()};
  }
  Descriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  Descriptor stop{::eventfd(0, EFD_CLOEXEC)};
  // What stands there was left behind by a holder that was killed.
  std::error_code none;
  if (std::filesystem::is_socket(path, none)) {
    std::filesystem::remove(path, none);
  }
  // Before it has a name, so that nobody else reaches it in between.
  if (!socket.is_open() || !stop.is_open() || ::fchmod(socket.number(), S_IRUSR | S_IWUSR) != 0 ||
      ::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address->name),
             sizeof(address->name)) != 0 ||
      ::listen(socket.number(), kCallersWaiting) != 0) {
    return socket_failure("listening at", path);
  }
  return std::unique_ptr<RequestServer>{
      new RequestServer{path, std::move(socket), std::move(stop), std::move(answer)}};
}

RequestServer::RequestServer(std::filesystem::path path, Descriptor socket, Descriptor stop,
                             Answer answer)
    : path_{std::move(path)},
      socket_{std::move(socket)},
      stop_{std::move(stop)},
      answer_{std::move(answer)},
      thread_{[this] { run(); }} {}

RequestServer::~RequestServer() {
  ::eventfd_write(stop_.number(), 1);
  thread_.join();
  std::error_code gone;
  std::filesystem::remove(path_, gone);
}

void RequestServer::run() {
  while (true) {
    std::array<pollfd, 2> waiting{{{.fd = stop_.number(), .events = POLLIN, .revents = 0},
                                   {.fd = socket_.number(), .events = POLLIN, .revents = 0}}};
    if (::poll(waiting.data(), waiting.size(), -1) < 0) {
      continue;
    }
    if (waiting[0].revents != 0) {
      return;
    }
    const Descriptor caller{::accept4(socket_.number(), nullptr, nullptr, SOCK_CLOEXEC)};
    if (caller.is_open()) {
      ::setsockopt(caller.number(), SOL_SOCKET, SO_RCVTIMEO, &kUntilAsked, sizeof(kUntilAsked));
      ::setsockopt(caller.number(), SOL_SOCKET, SO_SNDTIMEO, &kUntilAsked, sizeof(kUntilAsked));
      serve(caller);
    }
  }
}

void RequestServer::serve(const Descriptor& caller) const {
  nlohmann::json answer;
  const auto line = receive_line(caller, kLongestRequest);
  const auto request =
      line ? nlohmann::json::parse(*line, nullptr, false) : nlohmann::json::object();
  if (!line || !request.is_object()) {
    answer = {
        {"error", line ? "a request must be a JSON object on one line" : line.error().message}};
  } else {
    try {
      answer = answer_(request);
    } catch (const std::exception& exception) {
      answer = {{"error", exception.what()}};
    }
  }
  const auto sent = send_all(caller, json_line(answer));
  if (!sent) {
    warn("answered_to_nobody", {{"why", sent.error().message}},
         "a request was answered to nobody: " + sent.error().message);
  }
}

}  // namespace spindrift
