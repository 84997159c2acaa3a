#include <string>

#include <gtest/gtest.h>

#include "report/block_html.h"

namespace patrol::report::svg_html_test {
namespace {

bool has(const std::string& html, const std::string& part) { return html.find(part) != std::string::npos; }

HeatMap two_columns() {
  return {.caption = "Lining at <goal_1>",
          .unit = "mm",
          .negative = "outward",
          .positive = "inward",
          .max = 4.0,
          .column_title = "ring",
          .columns = {"20", "21"},
          .rows = {"crown", ""},
          .cells = {{0, 0, 4.0}, {1, 0, -2.0}, {0, 1, 0.1}},
          .marks = {{0, 0, "+4.0 mm"}},
          .notes_title = "true peak, mm",
          .notes = {{.column = 1, .text = "5.0", .tone = Tone::kBad}}};
}

TEST(HeatMapHtml, OpacityIsTheRatioToTheMaximumAndTheClassTheSign) {
  const std::string html = to_html(two_columns());
  EXPECT_TRUE(has(html, R"(<path class="positive" fill-opacity="1.0")"));
  EXPECT_TRUE(has(html, R"(<path class="negative" fill-opacity="0.5")"));
  EXPECT_FALSE(has(html, R"(fill-opacity="0.0")"));
}

TEST(HeatMapHtml, TextsAreEscapedAndTheColumnWithoutANoteHasNone) {
  const std::string html = to_html(two_columns());
  EXPECT_TRUE(has(html, "Lining at &lt;goal_1&gt;"));
  EXPECT_FALSE(has(html, "<goal_1>"));
  EXPECT_TRUE(has(html, R"(<text class="bad")"));
  EXPECT_TRUE(has(html, ">crown</text>"));
}

TEST(PlanViewHtml, BothAxesHaveTheSameScale) {
  const PlanView view{
      .caption = "Water",
      .x_title = "ahead, m",
      .y_title = "left, m",
      .low_m = {0.0, 0.0},
      .high_m = {10.0, 5.0},
      .paths = {{.name = "body", .color = SeriesColor::kTruth, .pieces_m = {{{0.0, 0.0}, {10.0, 5.0}}}}},
      .marks = {}};
  const std::string html = to_html(view);
  EXPECT_TRUE(has(html, R"(points="44.0,216.0 464.0,6.0 ")")) << html;  // 42 px per m
  EXPECT_TRUE(has(html, "<span class=\"key truth\">body</span>"));
}

}  // namespace
}  // namespace patrol::report::svg_html_test
