/// @file
/// An HTTP client that opens one connection for each request, and a reader of event streams.

#pragma once

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace spindrift {

using HttpSocket = boost::asio::ip::tcp::socket;
using HttpReply = boost::beast::http::response<boost::beast::http::string_body>;

/// Reads a server-sent event stream.
struct EventViewer {
  HttpSocket socket;
  std::string unread = {};

  /// Returns the text up to and including `end`; throws if the connection ends before.
  std::string until(const std::string& end) {
    const auto length = boost::asio::read_until(socket, boost::asio::dynamic_buffer(unread), end);
    const std::string text = unread.substr(0, length);
    unread.erase(0, length);
    return text;
  }
};

class HttpClient {
 public:
  /// @param url Address as http://127.0.0.1:PORT/.
  explicit HttpClient(const std::string& url)
      : port_{static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)))} {}

  HttpSocket connected() {
    HttpSocket socket{context_};
    socket.connect({boost::asio::ip::make_address("127.0.0.1"), port_});
    return socket;
  }
  /// Sends `text` on a new connection and returns that connection.
  HttpSocket call(const std::string& text) {
    HttpSocket socket = connected();
    boost::asio::write(socket, boost::asio::buffer(text));
    return socket;
  }
  static HttpReply reply(HttpSocket socket) {
    boost::beast::flat_buffer buffer;
    HttpReply reply;
    boost::beast::http::read(socket, buffer, reply);
    return reply;
  }
  HttpReply get(const std::string& target, const std::string& host = "localhost") {
    return reply(call("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n"));
  }
  nlohmann::json get_json(const std::string& target) {
    return nlohmann::json::parse(get(target).body());
  }
  HttpReply post(const std::string& target, const std::string& body, const std::string& token) {
    return reply(call("POST " + target + " HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer " +
                      token + "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" +
                      body));
  }
  /// Opens the event stream.
  /// @param head Additional header lines, each ended by CRLF.
  EventViewer watch(const std::string& head = "") {
    return {call("GET /api/v1/events HTTP/1.1\r\nHost: localhost\r\n" + head + "\r\n")};
  }

 private:
  std::uint16_t port_;
  boost::asio::io_context context_;
};

}  // namespace spindrift
