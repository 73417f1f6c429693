/// @file
/// What comes in and goes out over HTTP, as Boost.Beast has it.

#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_range.hpp>
#include <boost/beast/http.hpp>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace spindrift {

namespace http = boost::beast::http;

/// Of a longer body only the beginning is kept, but all of it is read: a client that is still
/// sending would not see the answer.
struct BoundedBody {
  static constexpr std::size_t kLongest = 16UL * 1024;
  struct value_type {
    std::string text;
    bool is_too_long = false;
  };
  /// As Beast wants it: http://www.boost.org/libs/beast, concept BodyReader.
  class reader {
   public:
    template <bool kIsRequest, class Fields>
    reader(http::header<kIsRequest, Fields>& /*head*/, value_type& body) : body_{body} {}
    static void init(const boost::optional<std::uint64_t>& /*length*/,
                     boost::system::error_code& failed) {
      failed = {};
    }
    template <class Buffers>
    std::size_t put(const Buffers& buffers, boost::system::error_code& failed) {
      failed = {};
      for (const auto buffer : boost::beast::buffers_range_ref(buffers)) {
        const std::size_t room = kLongest - body_.text.size();
        body_.is_too_long = body_.is_too_long || buffer.size() > room;
        body_.text.append(static_cast<const char*>(buffer.data()), std::min(buffer.size(), room));
      }
      return boost::asio::buffer_size(buffers);
    }
    static void finish(boost::system::error_code& failed) { failed = {}; }

   private:
    value_type& body_;
  };
};

using HttpRequest = http::request<BoundedBody>;
using HttpResponse = http::response<http::string_body>;

inline std::string_view view(boost::beast::string_view text) { return {text.data(), text.size()}; }

/// With the policy of the console; the connection ends with it.
HttpResponse answer(http::status status, std::string_view type, std::string body);
HttpResponse json_answer(http::status status, const nlohmann::json& json);
HttpResponse refusal(http::status status, std::string_view why);

/// The head of an answer that goes on until either side ends it.
std::string event_stream_head();

}  // namespace spindrift
