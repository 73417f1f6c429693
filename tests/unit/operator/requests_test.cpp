#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>

#include "services/operator/request_server.h"
#include "services/operator/request_socket.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::requests_test {

using nlohmann::json;

json twice(const json& request) {
  const std::string text = request.at("text").get<std::string>();
  return {{"text", text + text}};
}

const RequestServer::Answers kAnswers{{"twice", twice}};

class Requests : public ::testing::Test {
 protected:
  std::filesystem::path archive() const { return folder_.path() / "pass.db"; }

  Descriptor connected() const {
    const auto address = address_of(socket_of(archive())).value();
    Descriptor caller{::socket(AF_UNIX, SOCK_STREAM, 0)};
    EXPECT_EQ(::connect(caller.number(), reinterpret_cast<const sockaddr*>(&address.name),
                        sizeof(address.name)),
              0);
    return caller;
  }

  TemporaryFolder folder_;
};

TEST_F(Requests, AreAnsweredOneAfterTheOther) {
  const auto server = RequestServer::start(archive(), kAnswers).value();
  // The second text is more than the kernel transfers at once.
  for (const std::string& text : {std::string{"ab\n\"c"}, std::string(500'000, 'x')}) {
    const auto answer =
        value_or_throw(ask_holder(archive(), {{"do", "twice"}, {"text", text}})).value();
    EXPECT_EQ(answer["text"], text + text);
  }
}

TEST_F(Requests, AreForTheUserOfTheServiceOnly) {
  const auto server = RequestServer::start(archive(), kAnswers).value();
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(socket_of(archive())).permissions(),
            perms::owner_read | perms::owner_write);
}

TEST_F(Requests, NobodyAnswersWhereThereIsNoServiceOrItWasKilled) {
  EXPECT_EQ(ask_holder(archive(), json::object()).value(), std::nullopt);
  {
    // The socket is left as by a killed process.
    const auto address = address_of(socket_of(archive())).value();
    const Descriptor socket{::socket(AF_UNIX, SOCK_STREAM, 0)};
    ASSERT_EQ(::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address.name),
                     sizeof(address.name)),
              0);
  }
  EXPECT_EQ(ask_holder(archive(), json::object()).value(), std::nullopt);
  const auto server = RequestServer::start(archive(), kAnswers).value();
  EXPECT_TRUE(ask_holder(archive(), {{"do", "twice"}, {"text", "a"}}).value());
}

TEST_F(Requests, ASocketGoesWithItsService) {
  RequestServer::start(archive(), kAnswers).value().reset();
  EXPECT_FALSE(std::filesystem::exists(socket_of(archive())));
}

TEST_F(Requests, WhatAnAnswerThrowsIsAnError) {
  const auto server =
      RequestServer::start(
          archive(),
          {{"find", [](const json&) -> json { throw std::runtime_error{"no such pass"}; }}})
          .value();
  EXPECT_EQ((*ask_holder(archive(), {{"do", "find"}}).value())["error"], "no such pass");
}

TEST_F(Requests, ThoseOfAnotherKindAreNotWaitedFor) {
  std::promise<void> asked;
  std::promise<void> stored;
  const auto server =
      RequestServer::start(archive(),
                           {{"act",
                             [&](const json&) -> json {
                               asked.set_value();
                               const auto until = std::chrono::seconds{10};
                               const auto is_stored = stored.get_future().wait_for(until);
                               return {{"stored", is_stored == std::future_status::ready}};
                             }},
                            {"twice", twice}})
          .value();
  auto acting = std::async(std::launch::async, [&] {
    return ask_holder(archive(), {{"do", "act"}});
  });
  asked.get_future().wait();
  EXPECT_EQ((*ask_holder(archive(), {{"do", "twice"}, {"text", "a"}}).value())["text"], "aa");
  stored.set_value();
  EXPECT_TRUE((*acting.get().value())["stored"]);
}

TEST_F(Requests, ASlowCallerHoldsUpNeitherOthersNorTheEnd) {
  auto server = RequestServer::start(archive(), kAnswers).value();
  const Descriptor slow = connected();
  const std::jthread sender{[&](const std::stop_token& stop) {
    while (!stop.stop_requested() && send_all(slow, " ")) {
      std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
  }};
  EXPECT_EQ((*ask_holder(archive(), {{"do", "twice"}, {"text", "a"}}).value())["text"], "aa");
  server.reset();
  EXPECT_FALSE(receive_line(slow));
}

TEST_F(Requests, OneThatDoesNotComeInTimeIsRefusedHoweverOftenAByteComes) {
  const auto server = RequestServer::start(archive(), kAnswers).value();
  const Descriptor slow = connected();
  const std::jthread sender{[&](const std::stop_token& stop) {
    while (!stop.stop_requested() && send_all(slow, " ")) {
      std::this_thread::sleep_for(std::chrono::milliseconds{500});
    }
  }};
  EXPECT_EQ(receive_line(slow).value(), R"({"error":"no request within 5 s"})");
}

TEST_F(Requests, WhatNobodyKnowsIsRefused) {
  const auto server = RequestServer::start(archive(), kAnswers).value();
  for (const json& request : {json{{"do", "thrice"}}, json{{"do", 3}}, json::object()}) {
    EXPECT_EQ((*ask_holder(archive(), request).value())["error"], "not known here: do = twice are");
  }
}

TEST_F(Requests, OneThatIsNoJsonOrTooLongIsRefused) {
  const auto server = RequestServer::start(archive(), kAnswers).value();
  for (const std::string& line :
       {std::string{"what?"}, std::string(100'000, '['), std::string(1'100'000, 'x')}) {
    const Descriptor caller = connected();
    // The server may close the connection before the end of an oversized request.
    static_cast<void>(send_all(caller, line + "\n"));
    const auto answer = receive_line(caller);
    EXPECT_TRUE(!answer || answer->find("error") != std::string::npos) << *answer;
    EXPECT_EQ(answer.has_value() || line.size() > 1'000'000, true);
  }
  EXPECT_TRUE(ask_holder(archive(), {{"do", "twice"}, {"text", "a"}}).value());
}

TEST_F(Requests, ALongPathIsNoObstacle) {
  const auto deep = folder_.path() / std::string(150, 'd');
  std::filesystem::create_directory(deep);
  const auto server = RequestServer::start(deep / "pass.db", kAnswers).value();
  EXPECT_TRUE(ask_holder(deep / "pass.db", {{"do", "twice"}, {"text", "a"}}).value());
  EXPECT_THAT(RequestServer::start(deep / std::string(100, 'n'), kAnswers),
              IsRefused(ErrorCode::InvalidConfiguration, _));
}

}  // namespace spindrift::requests_test
