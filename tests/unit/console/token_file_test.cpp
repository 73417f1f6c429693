#include "services/console/token_file.h"

#include <filesystem>

#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_of.h"

namespace spindrift::token_file_test {

namespace fs = std::filesystem;

TEST(TokenFile, IsMadeOnceForItsUserAlone) {
  const TemporaryFolder folder;
  const fs::path db = folder.path() / "pass.db";
  const auto token = value_or_throw(token_of(db));
  EXPECT_EQ(token.size(), 64U);
  const fs::path file = folder.path() / "pass.db.token";
  EXPECT_EQ(text_of(file), token + "\n");
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(token_of(db), token);
}

TEST(TokenFile, ThatIsNoneIsRefused) {
  const TemporaryFolder folder;
  const fs::path db = folder.path() / "pass.db";
  const fs::path file = folder.write("pass.db.token", "0123456789abcdef0123456789abcdef\n");
  fs::permissions(file, fs::perms::group_read, fs::perm_options::add);
  EXPECT_THAT(token_of(db).error().message, HasSubstr("others can read it"));
  fs::permissions(file, fs::perms::owner_read);
  EXPECT_EQ(token_of(db), "0123456789abcdef0123456789abcdef");
  fs::remove(file);
  fs::permissions(folder.write("pass.db.token", "short\n"), fs::perms::owner_read);
  EXPECT_THAT(token_of(db).error().message, HasSubstr("fewer than 16"));
  EXPECT_EQ(token_of(folder.path() / "no" / "pass.db").error().code, ErrorCode::Unavailable);
}

TEST(TokenFile, ComparesWholeTokens) {
  EXPECT_TRUE(is_same_token("abc", "abc"));
  for (const char* const given : {"", "ab", "abd", "abcd"}) {
    EXPECT_FALSE(is_same_token("abc", given)) << given;
  }
}

}  // namespace spindrift::token_file_test
