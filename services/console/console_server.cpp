#include "services/console/console_server.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <charconv>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <thread>
#include <utility>
#include <variant>

#include "services/base/contained.h"
#include "services/console/token_file.h"
#include "services/serving/background_solving.h"

namespace spindrift {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using tcp = asio::ip::tcp;
using Failed = boost::system::error_code;

// Time limit for reading a request, for sending an answer and for each write to a viewer.
constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::milliseconds kLook{125};
constexpr int kLooksAPulseBatch = 2;
constexpr int kLooksAState = 8;
constexpr int kLooksAStateWithNews = 2;  // At least so many.
// Enough for twenty browsers that load the page at the same time.
constexpr int kMostConnections = 128;
// Connections above this are closed without an answer.
constexpr int kMostOpen = 2 * kMostConnections;
constexpr std::chrono::milliseconds kUntilNextAccept{100};
// Limits what the kernel buffers for a viewer that has stopped reading.
constexpr int kSendBuffer_bytes = 128 * 1024;

Expected<tcp::endpoint> endpoint_of(const std::string& address) {
  const auto colon = address.rfind(':');
  std::string host = colon == std::string::npos ? "" : address.substr(0, colon);
  if (host.empty() || host == "localhost") {
    host = "127.0.0.1";
  } else if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  }
  Failed failed;
  const auto numeric = asio::ip::make_address(host, failed);
  const char* const begin = address.data() + (colon == std::string::npos ? 0 : colon + 1);
  const char* const end = address.data() + address.size();
  std::uint16_t port = 0;
  const auto [rest, error] = std::from_chars(begin, end, port);
  if (failed || error != std::errc{} || rest != end) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("--console {}: must be HOST:PORT with a numeric host, as in "
                                   "127.0.0.1:0",
                                   address)}};
  }
  return tcp::endpoint{numeric, port};
}

std::string host_of(const tcp::endpoint& endpoint) {
  const std::string host = endpoint.address().to_string();
  return endpoint.address().is_v6() ? "[" + host + "]" : host;
}

std::set<std::string> hosts_of(const ConsoleOptions& options, const tcp::endpoint& endpoint) {
  std::set<std::string> hosts{"localhost", host_of(endpoint)};
  for (const std::string& name : options.names) {
    hosts.insert(boost::algorithm::to_lower_copy(name));
  }
  return hosts;
}

/// Returns false for a connection ended by the client or the network.
bool is_bad_http(Failed failed) {
  return failed.category() == Failed{http::error::bad_value}.category() &&
         failed != http::error::end_of_stream && failed != http::error::partial_message;
}

/// A connection, which is closed after its answer.
struct Session {
  Session(tcp::socket socket, int& count) : stream{std::move(socket)}, open{count} {
    ++open;
    parser.body_limit(std::numeric_limits<std::uint64_t>::max());  // See BoundedBody.
  }
  ~Session() { --open; }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  Session(Session&&) = delete;
  Session& operator=(Session&&) = delete;

  beast::tcp_stream stream;
  beast::flat_buffer buffer;
  http::request_parser<BoundedBody> parser;
  HttpResponse response;
  std::string events = {};
  std::uint64_t seen = 0;  ///< `id` of the last event sent.
  bool writing = false;
  int& open;
};
using Shared = std::shared_ptr<Session>;

}  // namespace

/// Runs everything on the single thread of the context except `make` of the answers.
class ConsoleServer::Loop {
 public:
  Loop(const ConsoleOptions& options, const ConsoleAnswers::Service& service, std::string token,
       const tcp::endpoint& endpoint)
      : feed_{service.feed},
        answers_{service, options.db, std::move(token), hosts_of(options, endpoint)},
        acceptor_{context_, endpoint} {
    accept();
    look();
    thread_ = std::thread{[this] {
      let_samples_come_first();
      const auto run = [this] { return contained("console", [this] { context_.run(); }); };
      for (auto ended = run(); !ended; ended = run()) {
        spdlog::error("the console goes on after a failure: {}", ended.error().message);
      }
    }};
  }
  ~Loop() {
    context_.stop();
    thread_.join();
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  Loop(Loop&&) = delete;
  Loop& operator=(Loop&&) = delete;

  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void accept() {
    acceptor_.async_accept([this](Failed failed, tcp::socket socket) {
      if (!failed) {
        read(std::make_shared<Session>(std::move(socket), open_));
      }
      if (!failed && open_ < kMostOpen) {
        accept();
        return;
      }
      // Out of descriptors, or too many connections: existing ones will end.
      accepting_.expires_after(kUntilNextAccept);
      accepting_.async_wait([this](Failed /*never*/) { accept(); });
    });
  }

  void read(const Shared& session) {
    session->stream.expires_after(kPatience);
    http::async_read(session->stream, session->buffer, session->parser,
                     [this, session](Failed failed, std::size_t /*bytes*/) {
                       if (!failed) {
                         serve(session);
                       } else if (is_bad_http(failed)) {
                         send(session, refusal(http::status::bad_request,
                                               "this is no HTTP: " + failed.message()));
                       }
                     });
  }

  void serve(const Shared& session) {
    Answer answer = answers_.to(session->parser.get(), open_ > kMostConnections, viewer_counts());
    if (auto* const response = std::get_if<HttpResponse>(&answer)) {
      send(session, std::move(*response));
    } else if (auto* const later = std::get_if<LaterAnswer>(&answer)) {
      send_when_made(making_.at(static_cast<std::size_t>(later->by)), session,
                     std::move(later->make));
    } else {
      watch(session, std::get<EventStream>(answer).id);
    }
  }

  void send_when_made(asio::thread_pool& on, Shared session, std::function<HttpResponse()> make) {
    asio::post(on, [this, session = std::move(session), make = std::move(make)]() mutable {
      let_samples_come_first();
      HttpResponse response;
      const auto made = contained("answering", [&] { response = make(); });
      if (!made) {
        response = refusal(http::status::internal_server_error, made.error().message);
      }
      asio::post(context_,
                 [session = std::move(session), response = std::move(response)]() mutable {
                   send(session, std::move(response));
                 });
    });
  }

  static void send(const Shared& session, HttpResponse response) {
    session->response = std::move(response);
    session->stream.expires_after(kPatience);
    http::async_write(session->stream, session->response,
                      [session](Failed /*failed*/, std::size_t /*bytes*/) {
                        Failed gone;
                        session->stream.socket().shutdown(tcp::socket::shutdown_send, gone);
                      });
  }

  void watch(const Shared& session, std::uint64_t id) {
    Failed ignored;  // Failure only means larger buffers.
    session->stream.socket().set_option(asio::socket_base::send_buffer_size{kSendBuffer_bytes},
                                        ignored);
    session->seen = id;
    session->events = event_stream_head();
    viewers_.insert(session);
    write(session);
    feed_.tell_state();  // Shows a state before the next second.
  }

  void write(const Shared& session) {
    session->writing = true;
    session->stream.expires_after(kPatience);
    asio::async_write(session->stream, asio::buffer(session->events),
                      [this, session](Failed failed, std::size_t /*bytes*/) {
                        session->writing = false;
                        if (failed == beast::error::timeout) {
                          drop(session);
                        } else if (failed) {
                          viewers_.erase(session);
                        } else {
                          tell(session);
                        }
                      });
  }

  /// Sends new events. Drops a viewer that is so far behind that it has missed events.
  void tell(const Shared& session) {
    if (!feed_.holds_all_after(session->seen)) {
      drop(session);
      return;
    }
    if (session->writing) {
      return;
    }
    EventRing::News news = feed_.after(session->seen);
    session->seen = news.last;
    session->events = std::move(news.text);
    if (!session->events.empty()) {
      write(session);
    }
  }

  void drop(const Shared& session) {
    ++dropped_;
    viewers_.erase(session);
    session->stream.close();
  }

  void look() {
    timer_.expires_after(kLook);
    timer_.async_wait([this](Failed /*never*/) {
      look();
      if (++looks_ % kLooksAPulseBatch == 0) {
        feed_.tell_pulses();
      }
      ++looks_since_state_;
      if (looks_since_state_ >= kLooksAState ||
          (looks_since_state_ >= kLooksAStateWithNews && feed_.has_news())) {
        feed_.tell_state();
        looks_since_state_ = 0;
      }
      for (const Shared& viewer : std::set<Shared>{viewers_}) {
        tell(viewer);
      }
    });
  }

  ViewerCounts viewer_counts() const { return {.watching = viewers_.size(), .dropped = dropped_}; }

  ConsoleFeed& feed_;
  ConsoleAnswers answers_;
  int open_ = 0;  // Outlives the context, which holds the sessions.
  int looks_ = 0;
  int looks_since_state_ = 0;
  std::uint64_t dropped_ = 0;
  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  asio::steady_timer accepting_{context_};
  asio::steady_timer timer_{context_};
  std::set<Shared> viewers_;
  /// A thread for each LaterAnswer::By.
  std::array<asio::thread_pool, 3> making_{asio::thread_pool{1}, asio::thread_pool{1},
                                           asio::thread_pool{1}};
  std::thread thread_;
};

ConsoleServer::ConsoleServer(std::string url, std::unique_ptr<Loop> loop)
    : url_{std::move(url)}, loop_{std::move(loop)} {}

ConsoleServer::~ConsoleServer() = default;

Expected<void> ConsoleServer::check(const std::string& address) {
  return endpoint_of(address).map([](const tcp::endpoint&) {});
}

Expected<std::unique_ptr<ConsoleServer>> ConsoleServer::start(
    const ConsoleOptions& options, const ConsoleAnswers::Service& service) {
  const auto endpoint = endpoint_of(options.address);
  if (!endpoint) {
    return Unexpected{endpoint.error()};
  }
  auto token = token_of(options.db);
  if (!token) {
    return Unexpected{token.error()};
  }
  try {
    auto loop = std::make_unique<Loop>(options, service, *std::move(token), *endpoint);
    const std::string url = fmt::format("http://{}:{}/", host_of(*endpoint), loop->port());
    return std::unique_ptr<ConsoleServer>{new ConsoleServer{url, std::move(loop)}};
  } catch (const boost::system::system_error& failed) {
    return Unexpected{
        {ErrorCode::Unavailable, fmt::format("--console {}: {}", options.address, failed.what())}};
  }
}

}  // namespace spindrift
