/// @file
/// Commands of spindrift on the bus of a test, and services that such commands run.

#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <string>
#include <utility>

#include "tests/support/ran.h"
#include "tests/support/service.h"

namespace spindrift {

inline Words on(const bus::BusConfig& bus, Words words) {
  return with(std::move(words),
              {"--domain", std::to_string(bus.domain), "--partition", bus.partition});
}

/// Stops a program that is expected to end well.
inline void stop_in_order(Program& program) {
  program.signal(SIGTERM);
  EXPECT_EQ(program.exit_status(), 0) << program.log();
}

/// A program `serve` that is ready when it is made.
struct Serving : Program {
  explicit Serving(const Words& words) : Program{words} { EXPECT_TRUE(says("ready")) << log(); }
};

/// A service that is ready when it is made.
class ReadyService : public Service {
 public:
  template <class... Arguments>
  explicit ReadyService(Arguments&&... arguments) : Service{std::forward<Arguments>(arguments)...} {
    EXPECT_TRUE(ready()) << log();
  }

  void go_on() {
    start();
    EXPECT_TRUE(ready()) << log();
  }
  void kill() {
    program().signal(SIGKILL);
    EXPECT_EQ(program().exit_status(), -1);
  }
  void kill_and_go_on() {
    kill();
    go_on();
  }
  /// Returns what the service printed at its end.
  nlohmann::json summary() { return nlohmann::json::parse(program().out()); }
  /// Returns a command for the mission and the bus of the service.
  Words words(Words command) const {
    return on(bus(), with(std::move(command), {"--mission", mission()}));
  }
};

}  // namespace spindrift
