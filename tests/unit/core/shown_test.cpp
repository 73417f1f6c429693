#include "pipelines/core/shown.h"

#include "tests/support/matchers.h"

namespace spindrift::shown_test {

TEST(Shown, LeavesTextOfAnyScriptAsItIs) {
  EXPECT_EQ(shown(""), "");
  EXPECT_EQ(shown("pass 7/pulses.csv"), "pass 7/pulses.csv");
  EXPECT_EQ(shown("J\u00fcrgen/\u65e5\u672c/\U0001F6F0"), "J\u00fcrgen/\u65e5\u672c/\U0001F6F0");
}

TEST(Shown, EscapesWhatATerminalWouldObey) {
  EXPECT_EQ(shown("\x1b[2J\r\n\t\x7f"), "\\x1b[2J\\x0d\\x0a\\x09\\x7f");
  EXPECT_EQ(shown(std::string_view{"a\0b", 3}), "a\\x00b");
  // CSI as one character, a line separator, and a right-to-left override.
  EXPECT_EQ(shown("\u009b2J"), "\\xc2\\x9b2J");
  EXPECT_EQ(shown("a\u2028b"), "a\\xe2\\x80\\xa8b");
  EXPECT_EQ(shown("\u202egnp.exe"), "\\xe2\\x80\\xaegnp.exe");
}

TEST(Shown, EscapesWhatIsNoUtf8) {
  EXPECT_EQ(shown("\xff\xfe"), "\\xff\\xfe");
  EXPECT_EQ(shown("caf\xe9"), "caf\\xe9");
  EXPECT_EQ(shown("caf\xe9 au lait"), "caf\\xe9 au lait");
  EXPECT_EQ(shown("\xc0\xaf"), "\\xc0\\xaf");                    // Overlong encoding.
  EXPECT_EQ(shown("\xe0\x80\xaf"), "\\xe0\\x80\\xaf");           // Overlong encoding.
  EXPECT_EQ(shown("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // Half of a surrogate pair.
  EXPECT_EQ(shown("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // Beyond the last code point.
  EXPECT_EQ(shown("\xe2\x82"), "\\xe2\\x82");                    // Truncated character.
}

TEST(Shown, IsAtMost200CharactersAndThePlaceOfTheRest) {
  EXPECT_EQ(shown(std::string(200, 'x')), std::string(200, 'x'));
  EXPECT_EQ(shown(std::string(201, 'x')), std::string(200, 'x').append("..."));
  std::string umlauts;
  for (int i = 0; i < 300; ++i) {
    umlauts += "\u00fc";
  }
  EXPECT_EQ(shown(umlauts), umlauts.substr(0, 400) + "...");
  EXPECT_EQ(shown(std::string(1'000'000, '\x01')).size(), 203U);
}

}  // namespace spindrift::shown_test
