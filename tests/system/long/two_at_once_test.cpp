// Two sources that send edges of one spacecraft at once, as fast as a live service takes them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/on_bus.h"
#include "tests/support/service.h"

namespace spindrift::two_at_once_test {

struct Served {
  std::vector<std::string> products;
  std::int64_t edges_told;      ///< Edges of which the run says what became of them.
  std::int64_t edges_left_out;  ///< Edges whose source is apart.
};

/// Serves the edges of one source each until all are computed.
Served serve(const std::vector<std::vector<Pulse>>& of_sources) {
  ReadyService service{"nominal"};
  std::vector<std::thread> senders;
  for (std::size_t i = 0; i < of_sources.size(); ++i) {
    senders.emplace_back([&, i] {
      EXPECT_TRUE(
          (FrontEnd{service.bus(), "SPINNER", of_sources[i], std::to_string(i)}.send_until(1.0)));
    });
  }
  for (std::thread& sender : senders) {
    sender.join();
  }
  EXPECT_EQ(service.stop_when_computed(), 0) << service.log();
  std::vector<std::string> products = product_rows(service.db());
  std::sort(products.begin(), products.end());
  return {.products = std::move(products),
          .edges_told = count_rows(service.db(), "pulse_use"),
          .edges_left_out = count_rows(service.db(), "pulse WHERE arrival < 0")};
}

TEST(TwoAtOnce, WithTheSameEdgesGiveWhatOneGives) {
  const std::vector<Pulse> pulses = pulses_of("nominal");
  const Served two = serve({pulses, pulses});
  EXPECT_EQ(two.products, serve({pulses}).products);
  EXPECT_EQ(two.edges_left_out, 0);
}

/// One of them soon sends more than a minute ahead of the other, which catches up with it.
TEST(TwoAtOnce, ThatShareTheEdgesLoseNoneAtTheStop) {
  std::vector<Pulse> even;
  std::vector<Pulse> odd;
  for (const Pulse& pulse : pulses_of("nominal")) {
    (even.size() == odd.size() ? even : odd).push_back(pulse);
  }
  for (int round = 0; round < 5; ++round) {
    const Served both = serve({even, odd});
    EXPECT_EQ(both.edges_told, std::ssize(even) + std::ssize(odd));
    EXPECT_EQ(both.edges_left_out, 0);
  }
}

}  // namespace spindrift::two_at_once_test
