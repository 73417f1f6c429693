#include <fmt/format.h>

#include <chrono>
#include <list>
#include <string>

#include "tests/integration/console/console_fixture.h"
#include "tests/support/eventually.h"
#include "tests/support/matchers.h"
#include "tests/support/some_health.h"

namespace spindrift::console_test {
namespace {

struct Console : ConsoleFixture {
  /// Starts another console on the same archive.
  auto started_at(const std::string& address) {
    return ConsoleServer::start({.address = address, .names = {}, .db = path()},
                                {.feed = feed_, .desk = desk_, .archive = *archive_});
  }
};

std::uint64_t last_id(const std::string& events) {
  return std::stoull(events.substr(events.rfind("\nid: ") + 5));
}

TEST_F(Console, TellsTheStateWithAnIdThatRises) {
  EventViewer viewer = client_->watch();
  const std::string first = viewer.until("event: state\ndata: {");
  EXPECT_THAT(first, HasSubstr("Content-Type: text/event-stream"));
  const auto id = last_id(first);
  EXPECT_THAT(viewer.until(fmt::format("id: {}\n", id + 1)), HasSubstr("alerts"));
}

TEST_F(Console, TellsANewAnswerBeforeTheNextStateIsDue) {
  EventViewer viewer = client_->watch();
  viewer.until("event: state");
  viewer.until("event: state");  // The next one that nothing calls for is a second away.
  const auto told = std::chrono::steady_clock::now();
  feed_.put("SPINNER", kRun, PassVerdict{.quality = Quality::Ok, .sigma_deg = 0.1, .against = ""});
  viewer.until("\"quality\":\"OK\"");
  EXPECT_LT(std::chrono::steady_clock::now() - told, std::chrono::milliseconds{500});
}

TEST_F(Console, TellsAViewerWhatItMissed) {
  EventViewer viewer = client_->watch();
  const auto id = last_id(viewer.until("event: state"));
  viewer.socket.close();
  feed_.tell_state();
  feed_.tell_state();
  EventViewer again = client_->watch(fmt::format("Last-Event-ID: {}\r\n", id));
  EXPECT_EQ(last_id(again.until("event: ")), id + 1);
}

TEST_F(Console, TellsAViewerOfAnEarlierStartAllThatIsNew) {
  feed_.tell_state();
  feed_.tell_state();
  EventViewer viewer = client_->watch("Last-Event-ID: 7\r\n");
  const auto id = last_id(viewer.until("event: alert\n"));
  EXPECT_GT(id, 7U);
  EXPECT_EQ(last_id(viewer.until("event: state\n")), id + 1);
}

TEST_F(Console, ServesTwentyViewersAndCountsThem) {
  std::list<EventViewer> viewers;
  for (int i = 0; i < 20; ++i) {
    viewers.push_back(client_->watch());
  }
  for (EventViewer& viewer : viewers) {
    EXPECT_THAT(viewer.until("event: state\n"), HasSubstr("200 OK"));
  }
  EXPECT_THAT(client_->get("/metrics").body(), HasSubstr("spindrift_viewers 20\n"));
  viewers.clear();
  EXPECT_TRUE(eventually([&] {
    return client_->get("/metrics").body().find("spindrift_viewers 0\n") != std::string::npos;
  }));
}

TEST_F(Console, DropsAViewerThatReadsNoMoreAndTellsTheOthersOn) {
  EventViewer slow{client_->connected()};
  slow.socket.set_option(boost::asio::socket_base::receive_buffer_size{4096});
  boost::asio::write(
      slow.socket,
      boost::asio::buffer(std::string{"GET /api/v1/events HTTP/1.1\r\nHost: localhost\r\n\r\n"}));
  slow.until("event: state\n");
  EventViewer good = client_->watch();
  good.until("event: state\n");
  std::string told;
  Health health = testing::some_health();
  health.message = std::string(512 * 1024, 'x');
  EXPECT_TRUE(eventually([&] {
    feed_.put(health);
    told = good.until("event: health\n");
    return client_->get("/metrics").body().find("spindrift_viewers_dropped_total 1\n") !=
           std::string::npos;
  }));
  EXPECT_THAT(told, HasSubstr("event: health"));
}

TEST_F(Console, RefusesConnectionsBeyondItsLimit) {
  std::list<HttpSocket> waiting;
  for (int i = 0; i < 128; ++i) {
    waiting.push_back(client_->connected());
  }
  EXPECT_TRUE(eventually([&] { return client_->get("/healthz").result_int() == 429U; }));
  waiting.clear();
  EXPECT_TRUE(eventually([&] { return client_->get("/healthz").result_int() == 200U; }));
}

TEST_F(Console, SaysThatItsPortIsTaken) {
  const std::string url = server_->url();
  EXPECT_THAT(started_at(url.substr(7, url.size() - 8)),
              IsRefused(ErrorCode::Unavailable, HasSubstr("in use")));
}

TEST_F(Console, RefusesAnAddressThatIsNone) {
  for (const char* const address : {"", "ship:80", "127.0.0.1:x", "127.0.0.1:99999"}) {
    EXPECT_THAT(started_at(address), IsRefused(ErrorCode::InvalidConfiguration, _)) << address;
  }
}

TEST_F(Console, EndsWithViewersConnected) {
  EventViewer viewer = client_->watch();
  viewer.until("event: state");
  server_.reset();
  std::string rest;
  boost::system::error_code end;
  boost::asio::read(viewer.socket, boost::asio::dynamic_buffer(rest), end);
  EXPECT_TRUE(end);
}

}  // namespace
}  // namespace spindrift::console_test
