#include "services/base/reasons_json.h"

#include "tests/support/matchers.h"

namespace spindrift::reasons_json_test {

using enum ReasonCode;

TEST(ReasonsJson, NamesCodesAndValues) {
  const std::vector<Reason> reasons{{ModelOff, {{"deg", 0.5}}},
                                    {Fixes, {{"count", std::int64_t{2}}}},
                                    {ChannelGated, {{"channel", "sun1"}}}};
  EXPECT_EQ(to_json_text(reasons), R"([{"code":"model_off","deg":0.5},{"code":"fixes","count":2},)"
                                   R"({"code":"channel_gated","channel":"sun1"}])");
}

TEST(ReasonsJson, ComesBackAsItWas) {
  const std::vector<Reason> reasons{
      {ModelOff, {{"deg", 1.0}}}, {Since, {{"since_tai_ns", std::int64_t{-7}}}}, {AwaitingFix}};
  EXPECT_EQ(reasons_of(to_json_text(reasons)), reasons);
}

TEST(ReasonsJson, LeavesOutWhatIsNoReason) {
  EXPECT_THAT(reasons_of("no JSON"), IsEmpty());
  EXPECT_THAT(reasons_of(R"({"code":"fixes"})"), IsEmpty());
  EXPECT_THAT(reasons_of(R"([7,{"count":2},{"code":"of a later program"},{"code":"fixes"}])"),
              ElementsAre(Reason{Fixes}));
}

}  // namespace spindrift::reasons_json_test
