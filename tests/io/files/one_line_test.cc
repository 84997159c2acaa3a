#include "io/files/one_line.h"

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

TEST(OneLine, LettersBeyondAsciiStay) { EXPECT_EQ(on_one_line("Größe 5 µm"), "Größe 5 µm"); }

}  // namespace
}  // namespace patrol::io::one_line_test
