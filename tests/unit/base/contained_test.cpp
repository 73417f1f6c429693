#include "services/base/contained.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

namespace spindrift::contained_test {

TEST(Contained, GivesWhatTheWorkGives) {
  EXPECT_TRUE(contained("work", [] {}));
  EXPECT_TRUE(contained("work", [] { return Expected<void>{}; }));
  const auto refused = contained("work", []() -> Expected<void> {
    return Unexpected{{ErrorCode::InvalidInput, "refused"}};
  });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::InvalidInput);
  EXPECT_EQ(refused.error().message, "refused");
}

TEST(Contained, MakesAnExceptionThatWouldEndTheProcessAnError) {
  Expected<void> no_memory;
  Expected<void> other;
  std::thread{[&] {
    no_memory = contained("announcing", [] { throw std::bad_alloc{}; });
    other = contained("announcing", [] { throw std::runtime_error{"no clock"}; });
  }}.join();
  ASSERT_FALSE(no_memory);
  EXPECT_EQ(no_memory.error().code, ErrorCode::Unavailable);
  EXPECT_EQ(no_memory.error().message, "announcing: out of memory");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().message, "announcing: no clock");
}

}  // namespace spindrift::contained_test
