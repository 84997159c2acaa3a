#include "io/files/markup_text.h"

#include <gtest/gtest.h>

namespace patrol::io::markup_text_test {
namespace {

TEST(EscapedMarkup, LeavesNoCharacterThatMeansSomething) {
  EXPECT_EQ(escaped_markup(R"(<b class="x">&'</b>)"), "&lt;b class=&quot;x&quot;&gt;&amp;&#39;&lt;/b&gt;");
}

TEST(EscapedMarkup, KeepsOtherAlphabetsLineEndsAndTabsButNoControlCharacters) {
  EXPECT_EQ(escaped_markup("Größe 5 °\n\t\x01\x1b"), "Größe 5 °&#10;&#9;  ");
}

}  // namespace
}  // namespace patrol::io::markup_text_test
