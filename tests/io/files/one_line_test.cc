#include "io/files/one_line.h"

#include <string>

#include <gtest/gtest.h>

namespace patrol::io::one_line_test {
namespace {

TEST(OneLine, ControlCharactersAreWrittenOut) { EXPECT_EQ(on_one_line("a\nb\x1b[31m\x7f"), "a\\nb\\x1b[31m\\x7f"); }

TEST(OneLine, C1ControlsAndBytesThatAreNotUtf8AreWrittenOut) {
  EXPECT_EQ(on_one_line("a\xc2\x9b"
                        "31m\xc2\x85"),
            "a\\x9b31m\\x85");
  EXPECT_EQ(on_one_line("a\x9b"
                        "31m\xff\xc3"),
            "a\\x9b31m\\xff\\xc3");
  EXPECT_TRUE(has_control_characters("a\xc2\x9b"));
  EXPECT_FALSE(
      has_control_characters("Gr\xc3\xb6\xc3\x9f"
                             "e \xe2\x82\xac"));
}

TEST(IsUtf8, OverlongFormsSurrogatesAndCutSequencesAreNone) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(
      is_utf8("/gr\xc3\xbc\xc3\x9f"
              "e/\xf0\x9f\xa4\x96"));
  for (const char* text : {"\xff", "a\xc3", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf0\x80\x80\x80"})
    EXPECT_FALSE(is_utf8(text)) << on_one_line(text);
}

TEST(FirstBytes, CutBeforeACharacterThatDoesNotFit) {
  EXPECT_EQ(first_bytes("abc", 3), "abc");
  EXPECT_EQ(first_bytes("abc", 2), "ab");
  const std::string robot = "a\xf0\x9f\xa4\x96z";
  for (const std::size_t max_bytes : {1U, 2U, 3U, 4U}) EXPECT_EQ(first_bytes(robot, max_bytes), "a");
  EXPECT_EQ(first_bytes(robot, 5), robot.substr(0, 5));
  EXPECT_EQ(first_bytes("\xc3\xa4", 0), "");
  EXPECT_EQ(first_bytes("ab\xff\xff\xff", 4), "ab\xff\xff");  // no UTF-8: cut where it is
}

TEST(OneLine, LettersBeyondAsciiStay) { EXPECT_EQ(on_one_line("Größe 5 µm"), "Größe 5 µm"); }

}  // namespace
}  // namespace patrol::io::one_line_test
