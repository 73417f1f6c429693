#include <fmt/format.h>

#include <fstream>

#include "tests/support/matchers.h"
#include "tests/support/program.h"
#include "tests/support/test_paths.h"

namespace spindrift::gigabyte_test {

/// Writes pulses at 100 rpm of another spacecraft, every block of a thousand in reverse order. They
/// are read and sorted like others but only counted, which saves minutes against storing them.
void write_gigabyte(const std::filesystem::path& path, std::int64_t rows) {
  std::ofstream file{path, std::ios::binary};
  file << "t_tai_ns,channel,spacecraft\n";
  fmt::memory_buffer text;
  for (std::int64_t i = 0; i < rows; ++i) {
    const std::int64_t place = i - i % 1000 + 999 - i % 1000;
    fmt::format_to(fmt::appender{text}, "{},north_out,OTHER\n",
                   1795143637000000000 + place * 100'000'000);
    if (i % 1000 == 999) {
      file.write(text.data(), static_cast<std::streamsize>(text.size()));
      text.clear();
    }
  }
}

TEST(Process, ReadsAGigabyteBelow400MiB) {
  if (is_sanitized()) {
    GTEST_SKIP() << "sanitizers need memory of their own";
  }
  const auto nominal = recorded_passes() / "nominal";
  const TemporaryFolder folder;
  constexpr std::int64_t kRows = 28'000'000;
  const auto large = folder.path() / "large.csv";
  write_gigabyte(large, kRows);
  ASSERT_GT(std::filesystem::file_size(large), 1'000'000'000U);
  Program program{{"process", "--mission", nominal / "mission.toml", "--telemetry", large,
                   nominal / "pulses.csv", "--db", folder.path() / "out.db", "--json"}};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  EXPECT_LT(program.peak_kib(), 400 * 1024);
  EXPECT_THAT(program.out(),
              HasSubstr(fmt::format("\"other_spacecraft\":{{\"OTHER\":{}}}", kRows)));
  EXPECT_THAT(program.out(), HasSubstr("\"edges_received\":3600"));
}

}  // namespace spindrift::gigabyte_test
