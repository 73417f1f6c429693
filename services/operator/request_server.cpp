#include "services/operator/request_server.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>

#include <array>
#include <exception>
#include <stop_token>
#include <string>
#include <utility>

#include "services/base/json_line.h"
#include "services/base/warning.h"

namespace spindrift {
namespace {

constexpr std::size_t kLongestRequest = 1 << 20;
constexpr timeval kUntilAsked{.tv_sec = 5, .tv_usec = 0};
constexpr int kCallersWaiting = 16;

void reply(const Descriptor& caller, const nlohmann::json& answer) {
  const auto sent = send_all(caller, json_line(answer));
  if (!sent) {
    warn("answered_to_nobody", {{"why", sent.error().message}},
         "a request was answered to nobody: " + sent.error().message);
  }
}

nlohmann::json answer_or_error(const RequestServer::Answer& answer, const nlohmann::json& request) {
  try {
    return answer(request);
  } catch (const std::exception& exception) {
    return {{"error", exception.what()}};
  }
}

}  // namespace

RequestServer::Counter::Counter(Answer answer)
    : answer_{std::move(answer)},
      waiting_{kCallersWaiting},
      thread_{[this](const std::stop_token& stop) {
        while (const auto asked = waiting_.take()) {
          if (stop.stop_requested()) {
            return;
          }
          reply(asked->caller, answer_or_error(answer_, asked->request));
        }
      }} {}

RequestServer::Counter::~Counter() {
  thread_.request_stop();
  waiting_.close();
}

void RequestServer::Counter::queue(Asked asked) {
  if (waiting_.size() >= kCallersWaiting) {
    reply(asked.caller, {{"error", "too many ask for this at once: ask again"}});
  } else {
    waiting_.push(std::move(asked));
  }
}

Expected<std::unique_ptr<RequestServer>> RequestServer::start(const std::filesystem::path& archive,
                                                              const Answers& answers) {
  const std::filesystem::path path = socket_of(archive);
  const auto address = address_of(path);
  if (!address) {
    return Unexpected{address.error()};
  }
  Descriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  Descriptor stop{::eventfd(0, EFD_CLOEXEC)};
  // An existing socket was left behind by a holder that was killed.
  std::error_code none;
  if (std::filesystem::is_socket(path, none)) {
    std::filesystem::remove(path, none);
  }
  // Permissions are set before the socket has a name, so that nobody else reaches it in between.
  if (!socket.is_open() || !stop.is_open() || ::fchmod(socket.number(), S_IRUSR | S_IWUSR) != 0 ||
      ::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address->name),
             sizeof(address->name)) != 0 ||
      ::listen(socket.number(), kCallersWaiting) != 0) {
    return socket_failure("listening at", path);
  }
  return std::unique_ptr<RequestServer>{
      new RequestServer{path, std::move(socket), std::move(stop), answers}};
}

RequestServer::RequestServer(std::filesystem::path path, Descriptor socket, Descriptor stop,
                             const Answers& answers)
    : path_{std::move(path)}, socket_{std::move(socket)}, stop_{std::move(stop)} {
  for (const auto& [what, answer] : answers) {
    counters_.try_emplace(what, answer);
  }
  thread_ = std::thread{[this] { run(); }};
}

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
    Descriptor caller{::accept4(socket_.number(), nullptr, nullptr, SOCK_CLOEXEC)};
    if (caller.is_open()) {
      ::setsockopt(caller.number(), SOL_SOCKET, SO_RCVTIMEO, &kUntilAsked, sizeof(kUntilAsked));
      ::setsockopt(caller.number(), SOL_SOCKET, SO_SNDTIMEO, &kUntilAsked, sizeof(kUntilAsked));
      serve(std::move(caller));
    }
  }
}

void RequestServer::serve(Descriptor caller) {
  const auto line = receive_line(caller, kLongestRequest);
  if (!line) {
    reply(caller, {{"error", line.error().message}});
    return;
  }
  auto request = nlohmann::json::parse(*line, nullptr, false);
  if (!request.is_object()) {
    reply(caller, {{"error", "a request must be a JSON object on one line"}});
    return;
  }
  const auto what = request.find("do");
  const auto counter = what != request.end() && what->is_string()
                           ? counters_.find(what->get<std::string>())
                           : counters_.end();
  if (counter == counters_.end()) {
    std::string known;
    for (const auto& [name, of_it] : counters_) {
      known += (known.empty() ? "" : ", ") + name;
    }
    reply(caller, {{"error", "not known here: do = " + known + " are"}});
    return;
  }
  counter->second.queue({.caller = std::move(caller), .request = std::move(request)});
}

}  // namespace spindrift
