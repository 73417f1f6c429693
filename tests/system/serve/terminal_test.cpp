#include <fcntl.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/bus_fixture.h"
#include "tests/support/eventually.h"
#include "tests/support/lines.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/pass_with.h"
#include "tests/support/program.h"
#include "tests/support/service.h"

namespace spindrift::serve_terminal_test {

using ::testing::AnyOf;

/// Holds a pseudo-terminal with 80 columns.
class Terminal {
 public:
  Terminal() {
    winsize size{.ws_row = 24, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
    std::array<char, 128> name{};
    EXPECT_EQ(openpty(&ours_, &theirs_, name.data(), nullptr, &size), 0);
    name_ = name.data();
    fcntl(ours_, F_SETFL, O_NONBLOCK);
  }
  ~Terminal() {
    close(theirs_);
    close(ours_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  const std::string& name() const { return name_; }
  /// Returns all text written so far.
  const std::string& text() {
    std::array<char, 4096> some{};
    for (ssize_t n = 0; (n = read(ours_, some.data(), some.size())) > 0;) {
      text_.append(some.data(), static_cast<std::size_t>(n));
    }
    return text_;
  }
  bool shows(const std::string& words) {
    return eventually([&] { return text().find(words) != std::string::npos; });
  }

 private:
  int ours_ = -1;
  int theirs_ = -1;
  std::string name_;
  std::string text_;
};

TEST(ServeTerminal, RewritesOneLineAndScrollsWhatChanges) {
  const PassWith pass{kSoonSilent};
  const bus::BusConfig bus = bus_of_its_own();
  Terminal terminal;
  Program service{on(bus, {"serve", "--mission", pass.mission(), "--db", pass.db}), 0, "",
                  terminal.name()};
  ASSERT_TRUE(terminal.shows("SPINNER waiting for telemetry")) << terminal.text();
  FrontEnd front_end{bus, "SPINNER", pulses_of("nominal")};
  ASSERT_TRUE(front_end.send_until(0.5));
  EXPECT_TRUE(terminal.shows("Z SILENT ")) << terminal.text();
  EXPECT_TRUE(terminal.shows(" SPINNER: link.silent: no telemetry: ")) << terminal.text();
  EXPECT_TRUE(terminal.shows(" OK 0.")) << terminal.text();
  ASSERT_TRUE(front_end.send_until(0.6));
  EXPECT_TRUE(terminal.shows(" SPINNER: link.silent: over at ")) << terminal.text();
  service.signal(SIGTERM);
  EXPECT_EQ(service.exit_status(), 0) << terminal.text();

  // The status line shows the axis instead.
  EXPECT_THAT(terminal.text(), Not(HasSubstr("SPINNER: axis RA ")));
  for (const std::string& drawn : lines_of(terminal.text(), '\r')) {
    if (drawn.starts_with("\x1b[KSPINNER ")) {
      EXPECT_LT(drawn.size(), std::string{"\x1b[K"}.size() + 80U) << drawn;
      EXPECT_THAT(drawn, Not(HasSubstr("\n"))) << drawn;
    }
  }
}

TEST(ServeTerminal, TellsProgramsAnObjectALine) {
  const PassWith pass{kSoonSilent};
  ReadyService service{pass.folder.path()};
  FrontEnd front_end{service.bus(), "SPINNER", pulses_of("nominal")};
  ASSERT_TRUE(front_end.send_until(0.1));
  ASSERT_TRUE(service.program().says("\"link.silent\"")) << service.log();
  ASSERT_TRUE(front_end.send_until(0.2));
  ASSERT_TRUE(service.program().says("\"cleared\"")) << service.log();
  ASSERT_EQ(service.stop_when_computed(), 0) << service.log();
  std::vector<std::string> states;
  for (const std::string& line : lines_of(service.log())) {
    const auto told = nlohmann::json::parse(line, nullptr, false);
    ASSERT_TRUE(told.is_object()) << line;
    if (told.contains("alert_id")) {
      EXPECT_EQ(told["spacecraft_id"], "SPINNER");
      EXPECT_TRUE(told["evidence"]["since_tai_ns"].is_number()) << line;
      if (told["key"] == "link.silent") {
        states.push_back(told["state"]);
      }
    } else {
      EXPECT_THAT(told["level"], AnyOf("info", "warning", "error")) << line;
      EXPECT_THAT(told["utc"].get<std::string>(), StartsWith("20")) << line;
      EXPECT_TRUE(told["text"].is_string()) << line;
    }
  }
  ASSERT_GE(states.size(), 2U);
  EXPECT_EQ(states[0], "active");
  EXPECT_EQ(states[1], "cleared");
  EXPECT_TRUE(service.summary().contains("runs"));
}

}  // namespace spindrift::serve_terminal_test
