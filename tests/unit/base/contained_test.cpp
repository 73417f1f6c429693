#include "services/base/contained.h"

#include <stdexcept>
#include <thread>

#include "tests/support/matchers.h"

namespace spindrift::contained_test {

TEST(Contained, GivesWhatTheWorkGives) {
  EXPECT_TRUE(contained("work", [] {}));
  EXPECT_TRUE(contained("work", [] { return Expected<void>{}; }));
  const auto refused = contained("work", []() -> Expected<void> {
    return Unexpected{{ErrorCode::InvalidInput, "refused"}};
  });
  EXPECT_THAT(refused, IsRefused(ErrorCode::InvalidInput, "refused"));
}

TEST(Contained, MakesAnExceptionThatWouldEndTheProcessAnError) {
  Expected<void> no_memory;
  Expected<void> other;
  std::thread{[&] {
    no_memory = contained("announcing", [] { throw std::bad_alloc{}; });
    other = contained("announcing", [] { throw std::runtime_error{"no clock"}; });
  }}.join();
  EXPECT_THAT(no_memory, IsRefused(ErrorCode::Unavailable, "announcing: out of memory"));
  EXPECT_THAT(other, IsRefused(ErrorCode::Unavailable, "announcing: no clock"));
}

}  // namespace spindrift::contained_test
