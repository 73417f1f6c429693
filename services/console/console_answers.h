/// @file
/// Answers the console's HTTP requests, independent of the connection.

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "services/alerts/alert_desk.h"
#include "services/archive/archive.h"
#include "services/console/alert_request.h"
#include "services/console/console_feed.h"
#include "services/console/http_messages.h"
#include "services/console/metrics.h"
#include "services/console/quantities.h"
#include "services/console/request_target.h"
#include "services/console/series.h"
#include "services/serving/kept_connection.h"

namespace spindrift {

class Webhook;

/// Answer made later, each kind by a thread of its own.
struct LaterAnswer {
  enum class By {
    Reading,  ///< The thread that reads the archive.
    Storing,  ///< A thread that waits until the archive has stored something.
    Acting,   ///< A thread that waits until an operator's action is stored.
  };
  By by;
  std::function<HttpResponse()> make;
};

/// Stream of the events after `id`, then of new ones.
struct EventStream {
  std::uint64_t id;
};
using Answer = std::variant<HttpResponse, LaterAnswer, EventStream>;

class ConsoleAnswers {
 public:
  /// The parts of the service, which outlive the console.
  struct Service {
    ConsoleFeed& feed;
    AlertDesk& desk;
    Archive& archive;
    const Webhook* webhook = nullptr;  ///< Null when alerts are sent nowhere.
    /// Takes an operator's action and waits until it is stored. @return Its id; InvalidInput for a
    /// bad one.
    std::function<Expected<std::string>(const nlohmann::json&)> act = {};
  };
  /// @param hosts Allowed values of the `Host` header, without port, in lower case.
  ConsoleAnswers(Service service, std::filesystem::path db, std::string token,
                 std::set<std::string> hosts);

  /// @param is_crowded Whether more connections are open than are served.
  Answer to(const HttpRequest& request, bool is_crowded, const ViewerCounts& viewers);

 private:
  using Get = std::function<Answer(const HttpRequest&, const RequestTarget&, const ViewerCounts&)>;
  void add_page();
  void add_api();

  bool is_host_known(const HttpRequest& request) const;
  Answer routed(const HttpRequest& request, const ViewerCounts& viewers);
  Answer events(const HttpRequest& request) const;
  Answer health() const;
  Answer quantities(const RequestTarget& target) const;
  Answer series(const RequestTarget& target);
  HttpResponse read_series(const std::string& run_id, const Quantity& quantity, const Span& span,
                           std::size_t points);
  bool has_token(const HttpRequest& request) const;
  Answer act(const HttpRequest& request) const;
  Answer change_alert(const HttpRequest& request, const AlertPath& path);
  HttpResponse change_alert(const OperatorWord& word);

  Service service_;
  std::string token_;
  std::set<std::string> hosts_;
  std::map<std::string, Get> gets_;  ///< Handlers by path.
  KeptConnection archive_;           ///< Used by the reading thread only.
};

}  // namespace spindrift
