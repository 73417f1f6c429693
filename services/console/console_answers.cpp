#include "services/console/console_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/beast/core/string.hpp>
#include <charconv>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "pipelines/core/shown.h"
#include "services/alerts/alert_json.h"
#include "services/alerts/webhook.h"
#include "services/base/parsed_json.h"
#include "services/console/page_files.h"
#include "services/console/token_file.h"

namespace spindrift {
namespace {

constexpr std::int64_t kMostPoints = 10'000;

std::string_view type_of(std::string_view path) {
  return path.ends_with(".js")    ? "text/javascript; charset=utf-8"
         : path.ends_with(".css") ? "text/css; charset=utf-8"
                                  : "text/html; charset=utf-8";
}

/// Returns the host of a `Host` header without its port.
std::string host_of(std::string_view header) {
  const auto colon = header.rfind(':');
  const bool has_port = colon != std::string_view::npos && !header.ends_with(']');
  return boost::algorithm::to_lower_copy(std::string{has_port ? header.substr(0, colon) : header});
}

HttpResponse bad_request(const Error& error) {
  return refusal(http::status::bad_request, error.message);
}

/// Refuses what was asked badly, or what the service cannot do now.
HttpResponse refusal_of(const Error& error) {
  return error.code == ErrorCode::InvalidInput
             ? bad_request(error)
             : refusal(http::status::service_unavailable, error.message);
}

HttpResponse not_served(const std::string& spacecraft) {
  return refusal(http::status::not_found,
                 fmt::format("no spacecraft {} is served", shown(spacecraft)));
}

/// Returns null when all are values.
template <class... Value>
const Error* first_error(const Expected<Value>&... values) {
  const Error* first = nullptr;
  ((first = first == nullptr && !values ? &values.error() : first), ...);
  return first;
}

HttpResponse not_allowed(const char* allowed) {
  HttpResponse response =
      refusal(http::status::method_not_allowed, fmt::format("only {}", allowed));
  response.set(http::field::allow, allowed);
  return response;
}

nlohmann::json json_of(const SeriesPoint& point) {
  nlohmann::json json{{"t_tai_ns", point.t_tai_ns}, {"value", point.value}};
  if (point.accepted) {
    json["accepted"] = *point.accepted;
  }
  if (!point.rejected_by.empty()) {
    json["rejected_by"] = point.rejected_by;
  }
  if (point.used) {
    json["used"] = *point.used;
  }
  if (point.held) {
    json["off"] = point.held->off;
    json["limit"] = point.held->limit;
    json["off_unit"] = point.held->unit;
  }
  return json;
}

HttpResponse unauthorized() {
  HttpResponse response =
      refusal(http::status::unauthorized,
              "no token, or a wrong one: it stands in the archive's path plus .token");
  response.set(http::field::www_authenticate, "Bearer");
  return response;
}

}  // namespace

ConsoleAnswers::ConsoleAnswers(Service service, std::filesystem::path db, std::string token,
                               std::set<std::string> hosts)
    : service_{std::move(service)},
      token_{std::move(token)},
      hosts_{std::move(hosts)},
      archive_{std::move(db)} {
  add_page();
  add_api();
}

void ConsoleAnswers::add_page() {
  for (const PageFile& file : page_files()) {
    const Get get = [file](const auto&, const auto&, const auto&) {
      return answer(http::status::ok, type_of(file.path), std::string{file.text});
    };
    gets_.emplace(file.path, get);
    if (file.path == "/index.html") {
      gets_.emplace("/", get);
    }
  }
}

void ConsoleAnswers::add_api() {
  gets_["/healthz"] = [this](const auto&, const auto&, const auto&) { return health(); };
  gets_["/metrics"] = [this](const auto&, const auto&, const ViewerCounts& viewers) {
    const auto failures = service_.webhook == nullptr
                              ? std::nullopt
                              : std::optional{service_.webhook->deliveries().failures()};
    return answer(http::status::ok, "text/plain; version=0.0.4; charset=utf-8",
                  metrics_text(service_.feed.state(), service_.archive.statistics(),
                               service_.feed.latencies(), viewers, failures));
  };
  gets_["/api/v1/state"] = [this](const auto&, const auto&, const auto&) {
    return json_answer(http::status::ok, service_.feed.state());
  };
  gets_["/api/v1/events"] = [this](const HttpRequest& request, const auto&, const auto&) {
    return events(request);
  };
  gets_["/api/v1/quantities"] = [this](const auto&, const RequestTarget& target, const auto&) {
    return quantities(target);
  };
  gets_["/api/v1/series"] = [this](const auto&, const RequestTarget& target, const auto&) {
    return series(target);
  };
}

Answer ConsoleAnswers::to(const HttpRequest& request, bool is_crowded,
                          const ViewerCounts& viewers) {
  if (request.body().is_too_long) {
    return refusal(http::status::payload_too_large, "the body has more than 16 KiB");
  }
  if (is_crowded) {
    return refusal(http::status::too_many_requests, "too many connections: try again");
  }
  if (!is_host_known(request)) {
    return refusal(http::status::bad_request,
                   "Host is no name of this console: start it with --console-host NAME");
  }
  return routed(request, viewers);
}

bool ConsoleAnswers::is_host_known(const HttpRequest& request) const {
  return request.count(http::field::host) == 1 &&
         hosts_.contains(host_of(view(request[http::field::host])));
}

Answer ConsoleAnswers::routed(const HttpRequest& request, const ViewerCounts& viewers) {
  const auto target = request_target(view(request.target()));
  if (!target) {
    return bad_request(target.error());
  }
  if (const auto get = gets_.find(target->path); get != gets_.end()) {
    return request.method() == http::verb::get ? get->second(request, *target, viewers)
                                               : not_allowed("GET");
  }
  if (target->path == "/api/v1/actions") {
    return request.method() == http::verb::post ? act(request) : not_allowed("POST");
  }
  if (const auto path = alert_path(target->path)) {
    return request.method() == http::verb::post ? change_alert(request, *path)
                                                : not_allowed("POST");
  }
  return refusal(http::status::not_found, "there is nothing here");
}

Answer ConsoleAnswers::events(const HttpRequest& request) const {
  const std::string_view last = view(request["Last-Event-ID"]);
  std::uint64_t id = std::numeric_limits<std::uint64_t>::max();  // By default only new events.
  std::from_chars(last.data(), last.data() + last.size(), id);
  return EventStream{.id = service_.feed.nearest(id)};
}

Answer ConsoleAnswers::health() const {
  const std::string trouble = service_.feed.trouble();
  return trouble.empty() ? json_answer(http::status::ok, {{"status", "ok"}})
                         : json_answer(http::status::service_unavailable,
                                       {{"status", "failing"}, {"error", trouble}});
}

Answer ConsoleAnswers::quantities(const RequestTarget& target) const {
  const auto spacecraft = target.text("spacecraft");
  if (!spacecraft) {
    return bad_request(spacecraft.error());
  }
  const auto kind = service_.feed.kind_of(*spacecraft);
  if (!kind) {
    return not_served(*spacecraft);
  }
  nlohmann::json all = nlohmann::json::array();
  for (const Quantity& quantity : quantities_of(*kind)) {
    all.push_back({{"name", quantity.name}, {"unit", quantity.unit}});
  }
  return json_answer(http::status::ok, {{"quantities", std::move(all)}});
}

Answer ConsoleAnswers::series(const RequestTarget& target) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  const auto spacecraft = target.text("spacecraft");
  const auto name = target.text("quantity");
  const auto from = target.integer("from", kLeast, kMost);
  const auto to = target.integer("to", from.value_or(kLeast), kMost);
  const auto points = target.integer("points", 1, kMostPoints);
  if (const Error* const error = first_error(spacecraft, name, from, to, points)) {
    return bad_request(*error);
  }
  const auto kind = service_.feed.kind_of(*spacecraft);
  if (!kind) {
    return not_served(*spacecraft);
  }
  const auto& known = quantities_of(*kind);
  const auto quantity = std::find_if(known.begin(), known.end(),
                                     [&](const Quantity& one) { return one.name == *name; });
  if (quantity == known.end()) {
    return refusal(
        http::status::bad_request,
        fmt::format("quantity = {}: must be one that /api/v1/quantities lists", shown(*name)));
  }
  return LaterAnswer{LaterAnswer::By::Reading,
                     [this, run_id = *service_.feed.run_of(*spacecraft), &quantity = *quantity,
                      span = Span{.from_tai_ns = *from, .to_tai_ns = *to},
                      most = static_cast<std::size_t>(*points)] {
                       return read_series(run_id, quantity, span, most);
                     }};
}

HttpResponse ConsoleAnswers::read_series(const std::string& run_id, const Quantity& quantity,
                                         const Span& span, std::size_t points) {
  const auto values = archive_.read(
      [&](SQLite::Database& archive) { return values_of(archive, run_id, quantity, span); });
  if (!values) {
    return refusal(http::status::service_unavailable, values.error().message);
  }
  if (!*values) {
    return bad_request(values->error());
  }
  nlohmann::json kept = nlohmann::json::array();
  for (const SeriesPoint& point : decimate(**values, points)) {
    kept.push_back(json_of(point));
  }
  return json_answer(http::status::ok, {{"points", std::move(kept)}});
}

bool ConsoleAnswers::has_token(const HttpRequest& request) const {
  constexpr std::string_view kScheme = "Bearer ";
  const std::string_view given = view(request[http::field::authorization]);
  return given.starts_with(kScheme) && is_same_token(token_, given.substr(kScheme.size()));
}

Answer ConsoleAnswers::act(const HttpRequest& request) const {
  if (!has_token(request)) {
    return unauthorized();
  }
  auto action = parsed_json(request.body().text);
  if (!action.is_object()) {
    return refusal(http::status::bad_request,
                   "the body must be a JSON object with spacecraft, by, action and its arguments");
  }
  return LaterAnswer{LaterAnswer::By::Acting, [this, action = std::move(action)] {
                       const auto taken = service_.act(action);
                       return taken ? json_answer(http::status::accepted, {{"action_id", *taken}})
                                    : refusal_of(taken.error());
                     }};
}

Answer ConsoleAnswers::change_alert(const HttpRequest& request, const AlertPath& path) {
  if (!has_token(request)) {
    return unauthorized();
  }
  const auto open = service_.desk.open();
  if (std::none_of(open.begin(), open.end(),
                   [&](const OpenAlert& one) { return one.alert.alert_id == path.alert_id; })) {
    return refusal(http::status::not_found,
                   fmt::format("no alert {} is open", shown(path.alert_id)));
  }
  auto word = operator_word(path, request.body().text);
  if (!word) {
    return bad_request(word.error());
  }
  return LaterAnswer{LaterAnswer::By::Storing,
                     [this, word = *std::move(word)] { return change_alert(word); }};
}

HttpResponse ConsoleAnswers::change_alert(const OperatorWord& word) {
  const auto taken = take_word(word, service_.desk, service_.archive);
  if (!taken) {
    return refusal_of(taken.error());
  }
  const auto& alert = std::get<Alert>(taken->products.front());
  return json_answer(http::status::ok, alert_json(taken->spacecraft_id, taken->run_id, alert));
}

}  // namespace spindrift
