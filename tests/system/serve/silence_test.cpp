#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/eventually.h"
#include "tests/support/on_bus.h"
#include "tests/support/service.h"

namespace spindrift::serve_silence_test {

using namespace std::chrono_literals;

TEST(Serve, ComputesASilentStreamToItsEndAndRepeatsThatAfterAKill) {
  constexpr std::size_t kEdges = 360;
  constexpr std::int64_t kEdgesOfARevolution = 6;
  std::vector<Pulse> pulses = pulses_of("nominal");
  pulses.resize(kEdges);
  ReadyService service{"nominal"};
  ASSERT_TRUE((FrontEnd{service.bus(), "SPINNER", pulses}.send_until(1.0)));
  const auto number = [&](const std::string& query) { return number_of(service.db(), query); };
  ASSERT_TRUE(eventually([&] {
    return number("SELECT count(*) FROM pulse_use WHERE revolution IS NOT NULL") >=
           static_cast<std::int64_t>(kEdges) - 2 * kEdgesOfARevolution;
  }));
  ASSERT_TRUE(eventually([&] { return number("SELECT count(*) FROM stream_silence") == 1; }));

  const Pulse late{.t = pulses[kEdges - kEdgesOfARevolution].t - 20ms,
                   .channel = PulseChannel::Sun2};
  ASSERT_TRUE((FrontEnd{service.bus(), "SPINNER", {late}}.send_until(1.0)));
  ASSERT_TRUE(eventually(
      [&] { return number("SELECT count(*) FROM pulse_use WHERE rejected_by = 'late'") == 1; }));

  service.kill();
  std::vector<std::string> before = product_rows(service.db());
  std::sort(before.begin(), before.end());
  service.go_on();
  EXPECT_TRUE(eventually([&] {
    std::vector<std::string> after = product_rows(service.db());
    std::sort(after.begin(), after.end());
    return std::includes(after.begin(), after.end(), before.begin(), before.end());
  }));
  ASSERT_EQ(service.stop(), 0) << service.log();
}

}  // namespace spindrift::serve_silence_test
