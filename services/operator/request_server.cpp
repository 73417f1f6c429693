#include "services/operator/request_server.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <exception>
#include <iterator>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "services/base/json_line.h"
#include "services/base/parsed_json.h"
#include "services/base/warning.h"

namespace spindrift {
namespace {

using std::chrono::steady_clock;

constexpr std::size_t kLongestRequest = 1 << 20;
constexpr timeval kUntilAsked{.tv_sec = 5, .tv_usec = 0};
constexpr std::size_t kCallersWaiting = 16;
const nlohmann::json kTooMany = {{"error", "too many ask at once: ask again"}};

/// Returns the milliseconds until a time, rounded up; 0 when it has passed.
int left_ms(steady_clock::time_point until) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - steady_clock::now());
  return static_cast<int>(std::max<std::int64_t>(left.count(), 0));
}

void reply(const Descriptor& caller, const nlohmann::json& answer) {
  const auto sent = send_all(caller, json_line(answer),
                             steady_clock::now() + std::chrono::seconds{kUntilAsked.tv_sec});
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
    reply(asked.caller, kTooMany);
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
      ::listen(socket.number(), static_cast<int>(kCallersWaiting)) != 0) {
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
  std::list<Caller> callers;  // They are in the order in which their time runs out.
  while (true) {
    std::vector<pollfd> waiting{{.fd = stop_.number(), .events = POLLIN, .revents = 0},
                                {.fd = socket_.number(), .events = POLLIN, .revents = 0}};
    for (const Caller& caller : callers) {
      waiting.push_back({.fd = caller.socket.number(), .events = POLLIN, .revents = 0});
    }
    if (::poll(waiting.data(), waiting.size(),
               callers.empty() ? -1 : left_ms(callers.front().until)) < 0) {
      continue;
    }
    if (waiting[0].revents != 0) {
      return;
    }
    auto polled = std::next(waiting.begin(), 2);
    std::erase_if(callers,
                  [&](Caller& caller) { return (polled++)->revents != 0 && hear(caller); });
    while (!callers.empty() && left_ms(callers.front().until) == 0) {
      reply(callers.front().socket,
            {{"error", fmt::format("no request within {} s", kUntilAsked.tv_sec)}});
      callers.pop_front();
    }
    if (waiting[1].revents != 0) {
      accept(callers);
    }
  }
}

void RequestServer::accept(std::list<Caller>& callers) {
  Descriptor caller{::accept4(socket_.number(), nullptr, nullptr, SOCK_CLOEXEC)};
  if (!caller.is_open()) {
    return;
  }
  ::setsockopt(caller.number(), SOL_SOCKET, SO_SNDTIMEO, &kUntilAsked, sizeof(kUntilAsked));
  if (callers.size() >= kCallersWaiting) {
    reply(caller, kTooMany);
    return;
  }
  callers.push_back({.socket = std::move(caller),
                     .until = steady_clock::now() + std::chrono::seconds{kUntilAsked.tv_sec}});
}

/// Takes what a caller has sent. @return Whether it is done with: asked, or gone.
bool RequestServer::hear(Caller& caller) {
  std::array<char, 4096> part{};
  const ssize_t now = ::recv(caller.socket.number(), part.data(), part.size(), MSG_DONTWAIT);
  if (now < 0) {
    return errno != EAGAIN && errno != EINTR;
  }
  caller.line.append(part.data(), static_cast<std::size_t>(now));
  if (const auto end = caller.line.find('\n'); end != std::string::npos) {
    caller.line.resize(end);
    serve(caller);
    return true;
  }
  if (caller.line.size() > kLongestRequest) {
    reply(caller.socket, {{"error", fmt::format("a request may have {} bytes", kLongestRequest)}});
    return true;
  }
  return now == 0;
}

void RequestServer::serve(Caller& asked) {
  const Descriptor& caller = asked.socket;
  auto request = parsed_json(asked.line);
  if (!request.is_object()) {
    reply(caller,
          {{"error",
            fmt::format("a request must be a JSON object on one line, nested at most {} deep",
                        kDeepestJson)}});
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
  counter->second.queue({.caller = std::move(asked.socket), .request = std::move(request)});
}

}  // namespace spindrift
