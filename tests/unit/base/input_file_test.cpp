#include "services/base/input_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <array>

#include "services/base/file_lines.h"
#include "services/base/sha256.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::input_file_test {

std::string refusal_of(const std::filesystem::path& path) {
  const auto text = read_text_file(path);
  if (text) {
    return "read";
  }
  EXPECT_EQ(text.error().code, ErrorCode::InvalidConfiguration);
  return text.error().message;
}

struct InputFileTest : ::testing::Test {
  const TemporaryFolder folder;
};

TEST_F(InputFileTest, IsReadWholeThroughALinkToo) {
  const std::string text(300'000, 'x');
  const auto path = folder.write("a.txt", text);
  EXPECT_EQ(read_text_file(path).value(), text);
  std::filesystem::create_symlink(path, folder.path() / "link");
  EXPECT_EQ(read_text_file(folder.path() / "link").value(), text);
  EXPECT_EQ(read_text_file(folder.write("empty.txt", "")).value(), "");
}

TEST_F(InputFileTest, DigestOfSeveralIsThatOfAllTheirBytes) {
  const std::string text(300'000, 'x');
  const std::array paths{folder.write("a.txt", text), folder.write("empty.txt", ""),
                         folder.write("b.txt", "b")};
  EXPECT_EQ(sha256_hex(paths).value(), sha256_hex(text + "b").value());
  EXPECT_EQ(sha256_hex(std::span{paths}.subspan(1, 1)).value(), sha256_hex("").value());
  EXPECT_FALSE(sha256_hex(std::array{paths[2], folder.path() / "none"}));
}

TEST_F(InputFileTest, ThatIsNoRegularFileIsRefusedAtOnce) {
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink(pipe, folder.path() / "link");
  for (const std::filesystem::path& path :
       {folder.path(), pipe, folder.path() / "link", std::filesystem::path{"/dev/zero"},
        std::filesystem::path{"/dev/null"}, std::filesystem::path{"/proc/self/status"},
        std::filesystem::path{"/proc/self/maps"}}) {
    EXPECT_EQ(refusal_of(path), path.string() + ": cannot be read: not a regular file");
  }
  EXPECT_THAT(refusal_of(folder.path() / "none"),
              EndsWith("cannot be read: No such file or directory"));
}

TEST_F(InputFileTest, ThatIsTooLargeIsRefusedBeforeItIsRead) {
  const auto path = folder.write("large.toml", "");
  std::filesystem::resize_file(path, kMostTextBytes);
  EXPECT_TRUE(InputFile::open(path, kMostTextBytes));
  std::filesystem::resize_file(path, kMostTextBytes + 1);
  EXPECT_THAT(refusal_of(path), EndsWith("67108865 bytes, must be 67108864 at most"));
}

TEST_F(InputFileTest, ThatFailsWhileReadingIsAnError) {
  const auto path = folder.write("a.txt", "text");
  // The file gets the lowest free descriptor, which is then closed.
  const int descriptor = dup(STDIN_FILENO);
  close(descriptor);
  auto file = InputFile::open(path).value();
  close(descriptor);
  std::array<char, 4> buffer{};
  EXPECT_THAT(
      file.read(buffer),
      IsRefused(ErrorCode::Unavailable, path.string() + ": reading failed: Bad file descriptor"));
}

TEST_F(InputFileTest, HasItsNameEscaped) {
  EXPECT_THAT(refusal_of(folder.path() / "a\x1b[2J\xff"), HasSubstr("/a\\x1b[2J\\xff: cannot"));
}

TEST_F(InputFileTest, GivesByLinesOnlyTheBeginningOfOneThatIsTooLong) {
  FileLines lines{
      InputFile::open(folder.write("a", std::string(1'000'000, 'x').append("\n\nb\r\nc"))).value()};
  FileLine line{};
  ASSERT_TRUE(lines.next(line).value());
  EXPECT_TRUE(line.too_long);
  EXPECT_EQ(line.text.size(), FileLines::kLongestLine);
  ASSERT_TRUE(lines.next(line).value());
  EXPECT_EQ(line.number, 3);
  EXPECT_EQ(line.text, "b");
  EXPECT_FALSE(line.too_long);
  ASSERT_TRUE(lines.next(line).value());
  EXPECT_EQ(line.text, "c");
  EXPECT_FALSE(lines.next(line).value());
}

TEST(Sha256, OfAFileIsThatOfItsBytes) {
  // FIPS 180-4, example 1.
  EXPECT_EQ(sha256_hex("abc").value(),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const TemporaryFolder folder;
  const std::string text(600'000, 'x');
  auto file = InputFile::open(folder.write("a", text)).value();
  EXPECT_EQ(sha256_hex(file).value(), sha256_hex(text).value());
  ASSERT_TRUE(file.rewind());
  EXPECT_EQ(sha256_hex(file).value(), sha256_hex(text).value());
}

}  // namespace spindrift::input_file_test
