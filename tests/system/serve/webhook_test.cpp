#include <atomic>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <csignal>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/pass_with.h"
#include "tests/support/service.h"

namespace spindrift::webhook_test {

namespace http = boost::beast::http;

/// Receives HTTP POST requests.
class Receiver {
 public:
  explicit Receiver(http::status answer = http::status::ok)
      : answer_{answer}, thread_{[this] { run(); }} {}
  ~Receiver() {
    stopping_ = true;
    boost::asio::ip::tcp::socket last{context_};
    boost::system::error_code ignored;
    last.connect(acceptor_.local_endpoint(), ignored);
    thread_.join();
  }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  std::string url() const {
    return "http://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port()) +
           "/api/v2/alerts";
  }
  int requests() const { return requests_; }
  std::vector<nlohmann::json> alerts() const {
    const std::lock_guard lock{mutex_};
    return alerts_;
  }

 private:
  void run() {
    while (true) {
      boost::asio::ip::tcp::socket socket = acceptor_.accept();
      if (stopping_) {
        return;
      }
      boost::beast::flat_buffer buffer;
      http::request<http::string_body> request;
      http::read(socket, buffer, request);
      ++requests_;
      {
        const std::lock_guard lock{mutex_};
        for (const auto& alert : nlohmann::json::parse(request.body())) {
          alerts_.push_back(alert);
        }
      }
      http::response<http::empty_body> response{answer_, request.version()};
      response.prepare_payload();
      http::write(socket, response);
    }
  }

  http::status answer_;
  boost::asio::io_context context_;
  boost::asio::ip::tcp::acceptor acceptor_{context_,
                                           {boost::asio::ip::make_address("127.0.0.1"), 0}};
  mutable std::mutex mutex_;
  std::vector<nlohmann::json> alerts_;
  std::atomic<int> requests_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

/// Runs a service with a webhook on a pass whose target attitude is far from the actual one.
struct Told {
  PassWith pass{std::string{kOffTarget} + "[alerts.\"alerts.undelivered\"]\nseconds = 3.0\n"};
  bus::BusConfig bus = bus_of_its_own();
  std::filesystem::path db = pass.folder.path() / "served.db";
  Serving service;

  Told(const Receiver& receiver, const std::string& partition)
      : service{serve(receiver, partition)} {}

  Words serve(const Receiver& receiver, const std::string& partition) {
    bus.partition = partition;
    return on(bus, {"serve", "--mission", pass.mission(), "--db", db, "--webhook", receiver.url()});
  }

  void send_pass() const {
    FrontEnd front_end{bus, "SPINNER", pulses_of("nominal")};
    ASSERT_TRUE(front_end.send_until(1.0));
    ASSERT_TRUE(eventually([&] {
      return count_rows(db, "alert WHERE key = 'spin.off_target'") == 1;
    })) << service.log();
  }
};

/// Returns the different labels of the alert that the target is off.
std::set<nlohmann::json> labels_of_off_target(const Receiver& receiver) {
  std::set<nlohmann::json> labels;
  for (const nlohmann::json& alert : receiver.alerts()) {
    if (alert["labels"]["alertname"] == "spin.off_target" &&
        alert["labels"]["spacecraft"] == "SPINNER") {
      labels.insert(alert["labels"]);
    }
  }
  return labels;
}

bool tells_off_target(const Receiver& receiver) { return !labels_of_off_target(receiver).empty(); }

TEST(Webhook, IsToldOfTheAlertsOfALiveService) {
  const Receiver receiver;
  Told told{receiver, "live"};
  told.send_pass();
  EXPECT_TRUE(eventually([&] { return tells_off_target(receiver); })) << told.service.log();
  stop_in_order(told.service);
}

TEST(Webhook, IsToldTheSameLabelsAfterARestart) {
  const Receiver first;
  Told told{first, "live"};
  told.send_pass();
  ASSERT_TRUE(eventually([&] { return tells_off_target(first); })) << told.service.log();
  told.service.signal(SIGKILL);
  static_cast<void>(told.service.exit_status());

  const Receiver second;
  Program again{told.serve(second, "live")};
  EXPECT_TRUE(eventually([&] { return tells_off_target(second); })) << again.log();
  EXPECT_EQ(labels_of_off_target(first).size(), 1U);
  EXPECT_EQ(labels_of_off_target(second), labels_of_off_target(first));
}

TEST(Webhook, IsToldNothingOfARehearsal) {
  const Receiver receiver;
  Told told{receiver, "replay"};
  EXPECT_THAT(told.service.log(), HasSubstr("a rehearsal: nothing is told to " + receiver.url()));
  told.send_pass();
  stop_in_order(told.service);
  EXPECT_TRUE(receiver.alerts().empty());
}

TEST(Webhook, IsNotToldWhatARehearsalHasLeftOpen) {
  const Receiver receiver;
  Told rehearsal{receiver, "replay"};
  rehearsal.send_pass();
  stop_in_order(rehearsal.service);
  ASSERT_GT(count_rows(rehearsal.db, "alert WHERE state <> 'cleared'"), 0);

  Serving service{rehearsal.serve(receiver, "live")};
  FrontEnd front_end{rehearsal.bus, "SPINNER", pulses_of("nominal")};
  ASSERT_TRUE(front_end.send_until(1.0));
  // The live run raises its own alert anew.
  EXPECT_TRUE(eventually([&] { return tells_off_target(receiver); })) << service.log();
  // The service tells its own alerts at once and stores them afterwards.
  for (const nlohmann::json& alert : receiver.alerts()) {
    const std::string mode_of_alert =
        "SELECT mode FROM alert JOIN run USING (run_id) WHERE alert_id = '" +
        alert["annotations"]["alert_id"].get<std::string>() + "'";
    EXPECT_TRUE(eventually([&] {
      return rows_of(rehearsal.db, mode_of_alert) == std::vector<std::string>{"live|"};
    })) << alert;
  }
  stop_in_order(service);
}

/// In the four seconds to the alert it is asked at once and after 1 and 3 s.
TEST(Webhook, ThatRefusesIsSaidAskedLessAndLessOftenAndHoldsNobodyUp) {
  const Receiver receiver{http::status::internal_server_error};
  Told told{receiver, "live"};
  told.send_pass();
  EXPECT_TRUE(told.service.says("does not take them: it answers with status 500"))
      << told.service.log();
  EXPECT_TRUE(eventually([&] {
    return count_rows(told.db, "alert WHERE key = 'alerts.undelivered'") == 1;
  })) << told.service.log();
  EXPECT_LE(receiver.requests(), 4);
  stop_in_order(told.service);
}

TEST(Webhook, IsAUrl) {
  const PassCopy pass{"nominal"};
  refused(on(bus_of_its_own(),
             {"serve", "--mission", pass.mission(), "--db", pass.db, "--webhook", "localhost"}),
          {"--webhook localhost: must be a URL"});
}

}  // namespace spindrift::webhook_test
