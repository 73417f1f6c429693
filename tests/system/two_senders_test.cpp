#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/lines.h"
#include "tests/support/matchers.h"
#include "tests/support/ran.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::two_senders_test {

const std::filesystem::path kPass = test_data() / "faults" / "two-senders";

struct Processed {
  nlohmann::json run;
  std::vector<std::string> attitudes;
  std::string log;
};

class TwoSenders : public ::testing::Test {
 protected:
  /// @param prefer Preferred source; empty for none.
  void prefer(const std::string& prefer) {
    mission_ = folder_.path() / "mission.toml";
    std::filesystem::copy_file(kPass / "orbit.oem", folder_.path() / "orbit.oem",
                               std::filesystem::copy_options::overwrite_existing);
    std::ofstream{mission_} << text_of(kPass / "mission.toml")
                            << fmt::format("[sources]\nprefer = \"{}\"\n", prefer);
  }

  Processed process(const std::string& name, const Words& telemetry) {
    db_ = folder_.path() / (name + ".db");
    const Ran program = succeeded(
        with({"process", "--mission", mission_, "--db", db_, "--json", "--telemetry"}, telemetry));
    return {
        .run = program.json()["runs"][0],
        .attitudes = rows_of(
            db_,
            "SELECT t_tai_ns, qx, qy, qz, qw, sigma_deg, quality FROM attitude ORDER BY t_tai_ns"),
        .log = program.log};
  }

  TemporaryFolder folder_;
  std::filesystem::path mission_ = kPass / "mission.toml";
  std::filesystem::path db_;
};

TEST_F(TwoSenders, NeitherIsUsedAndBothAreKeptAndNamed) {
  const std::int64_t fixes = 80;
  for (const bool second_first : {false, true}) {
    SCOPED_TRACE(second_first);
    const Processed both = second_first ? process("second-first", {kPass / "second", kPass})
                                        : process("second-last", {kPass, kPass / "second"});
    EXPECT_THAT(both.attitudes, IsEmpty());
    EXPECT_TRUE(both.run["attitude"].is_null());
    const auto stars = both.run["contradictions"]["star"].get<std::int64_t>();
    EXPECT_GT(stars, fixes);
    EXPECT_EQ(both.run["sensors"]["star"]["rejected"]["contradicted"], stars);
    EXPECT_EQ(both.run["sensors"]["star"]["accepted"], 0);
    EXPECT_THAT(
        rows_of(
            db_,
            "SELECT kind, source, used, count(*) FROM contradiction GROUP BY 1, 2, 3 ORDER BY 2"),
        ElementsAre(fmt::format("star|second/star.csv|0|{}|", stars),
                    fmt::format("star|two-senders/star.csv|0|{}|", stars)));
    EXPECT_THAT(rows_of(db_,
                        "SELECT key, severity, state, json_extract(evidence, '$.sources[0]'), "
                        "json_extract(evidence, '$.sources[1]') FROM alert WHERE key LIKE "
                        "'link.contradiction:%' ORDER BY key"),
                ElementsAre("link.contradiction:second/star.csv|warning|active|second/star.csv|"
                            "two-senders/star.csv|",
                            "link.contradiction:two-senders/star.csv|warning|active|"
                            "second/star.csv|two-senders/star.csv|"));
    EXPECT_THAT(both.log, HasSubstr("have different values"));
  }
}

TEST_F(TwoSenders, ThePreferredOneIsUsedWhateverItIsCalled) {
  const Processed alone = process("alone", {kPass});
  ASSERT_THAT(alone.attitudes, SizeIs(::testing::Gt(100U)));
  EXPECT_TRUE(alone.run["contradictions"].empty());
  for (const std::string& name :
       {std::string{"two-senders/star.csv"}, (kPass / "star.csv").string()}) {
    SCOPED_TRACE(name);
    prefer(name);
    const Processed both = process("preferred", {kPass / "second", kPass});
    EXPECT_EQ(both.attitudes, alone.attitudes);
    EXPECT_EQ(count_rows(db_, "contradiction WHERE used = 1 AND source = 'two-senders/star.csv'"),
              both.run["contradictions"]["star"]);
    EXPECT_EQ(count_rows(db_, "contradiction WHERE used = 1 AND source = 'second/star.csv'"), 0);
    EXPECT_THAT(rows_of(db_, "SELECT key FROM alert WHERE key LIKE 'link.contradiction:%'"),
                ElementsAre("link.contradiction:second/star.csv|"));
    std::filesystem::remove(db_);
  }
}

TEST_F(TwoSenders, APreferredOneThatIsNoneOfTheFilesIsSaid) {
  prefer("star.csv");
  const Processed both = process("none", {kPass, kPass / "second"});
  EXPECT_THAT(both.attitudes, IsEmpty());
  EXPECT_THAT(both.log, HasSubstr("sources.prefer = \"star.csv\" is not one of the files"));
}

TEST_F(TwoSenders, TheValuesOfALaterRunAreItsOwnAndThatIsSaid) {
  const Processed one = process("archive", {kPass});
  EXPECT_THAT(one.log, Not(HasSubstr("than an earlier run")));
  const Processed other = process("archive", {kPass / "second"});
  EXPECT_THAT(other.log, HasSubstr("star samples have other values than an earlier run has"));
  EXPECT_GT(count_rows(db_, "contradiction WHERE used = 1"), 0);
  EXPECT_GT(count_rows(db_, "notice WHERE code = 'contradicts_earlier_run'"), 0);
}

/// The copy has four decimals where the original has twelve.
TEST_F(TwoSenders, ACopyWithFewerDigitsIsTheSameSample) {
  const auto copy = folder_.path() / "copy";
  std::filesystem::create_directory(copy);
  std::ofstream{copy / "star.csv"}
      << with_rows(text_of(kPass / "star.csv"), [](const std::string& row) {
           return with_numbers(row, [](double value) { return fmt::format("{:.4f}", value); });
         });
  const Processed alone = process("alone", {kPass});
  const Processed both = process("both", {kPass, copy});
  EXPECT_EQ(both.attitudes, alone.attitudes);
  EXPECT_THAT(both.log, HasSubstr("of one of them with fewer digits"));
  EXPECT_EQ(count_rows(db_, "contradiction"), 0);
  EXPECT_EQ(count_rows(db_, "alert WHERE key LIKE 'link.contradiction:%'"), 0);
}

}  // namespace spindrift::two_senders_test
