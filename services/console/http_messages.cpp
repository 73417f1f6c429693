#include "services/console/http_messages.h"

#include <fmt/format.h>

#include <utility>

#include "services/base/json_line.h"

namespace spindrift {
namespace {

constexpr unsigned kHttp11 = 11;

void add_policy(http::fields& fields) {
  fields.set("Content-Security-Policy",
             "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
             "img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  fields.set("X-Content-Type-Options", "nosniff");
  fields.set("Referrer-Policy", "no-referrer");
  fields.set(http::field::cache_control, "no-cache");
  fields.set(http::field::connection, "close");
}

}  // namespace

HttpResponse answer(http::status status, std::string_view type, std::string body) {
  HttpResponse response{status, kHttp11};
  add_policy(response);
  response.set(http::field::content_type, {type.data(), type.size()});
  response.body() = std::move(body);
  response.prepare_payload();
  return response;
}

HttpResponse json_answer(http::status status, const nlohmann::json& json) {
  return answer(status, "application/json", json_line(json));
}

HttpResponse refusal(http::status status, std::string_view why) {
  return json_answer(status, {{"error", why}});
}

std::string event_stream_head() {
  http::fields fields;
  add_policy(fields);
  fields.set(http::field::content_type, "text/event-stream");
  std::string head = "HTTP/1.1 200 OK\r\n";
  for (const auto& field : fields) {
    head += fmt::format("{}: {}\r\n", view(field.name_string()), view(field.value()));
  }
  return head + "\r\nretry: 1000\n\n";
}

}  // namespace spindrift
