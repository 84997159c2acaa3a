#include "io/one_line.h"

#include <gtest/gtest.h>

namespace patrol::io::one_line_test {
namespace {

TEST(OneLine, ControlCharactersAreWrittenOut) { EXPECT_EQ(on_one_line("a\nb\x1b[31m\x7f"), "a\\nb\\x1b[31m\\x7f"); }

TEST(OneLine, LettersBeyondAsciiStay) { EXPECT_EQ(on_one_line("Größe 5 µm"), "Größe 5 µm"); }

}  // namespace
}  // namespace patrol::io::one_line_test
