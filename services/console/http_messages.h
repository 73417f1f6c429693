/// @file
/// HTTP messages as Boost.Beast types.

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

/// Keeps only the beginning of a long body but reads all of it, because a client that is still
/// sending would not see the answer.
struct BoundedBody {
  static constexpr std::size_t kLongest = 16UL * 1024;
  struct value_type {
    std::string text;
    bool is_too_long = false;
  };
  /// Implements the Beast concept BodyReader, see http://www.boost.org/libs/beast.
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

/// Returns an answer with the console's security policy that closes the connection.
HttpResponse answer(http::status status, std::string_view type, std::string body);
HttpResponse json_answer(http::status status, const nlohmann::json& json);
HttpResponse refusal(http::status status, std::string_view why);

/// Returns the header of an answer that continues until either side closes it.
std::string event_stream_head();

}  // namespace spindrift
