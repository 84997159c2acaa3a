#include "report/page.h"

#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::report::page_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kHostile = "</script><img src=x onerror=alert(1)>\"'&";

Curve long_curve() {
  Curve curve{.name = "estimate", .points = {}};
  for (int i = 0; i < 20000; ++i) curve.points.emplace_back(0.01 * i, i == 777 ? 12.5 : 0.01);
  return curve;
}

/// One block of every kind, with the same text wherever a text can stand.
Page page_of_everything(const std::string& text) {
  const TableBlock table{.caption = text, .columns = {{text}, {text, true}}, .rows = {{{text}, {text, Tone::kBad}}}};
  const PlotAxis axis{.label = text, .max = 200.0};
  const PlotMark mark{1.0, text, SeriesColor::kEvent};
  const PlotSpan span{.from = 1.0, .to = 2.0, .text = text};
  Curve curve = long_curve();
  curve.name = text;
  return {
      .kind = text,
      .title = text,
      .facts = {{text, text}},
      .sections = {{.title = "", .blocks = {VerdictBlock{text, Tone::kBad, text, table}}},
                   {.title = text,
                    .blocks = {TextBlock{text}, KeyMetrics{{{text, text, text, text}}}, table,
                               CollapsibleTables{text, {table}}, BarBlock{text, {{text, 1.0, text}}},
                               BoxPlot{text, text, {{text, {1.0, 2.0, 4.0}, 1.5, 2.0, 3.0, text}}},
                               WaterfallChart{text, text, {{text, -1.0, 2.0, std::pair(1.5, 2.5), Tone::kBad, text}}},
                               LinePlot{text, text, axis, {}, {curve}, {mark}, {span}},
                               EventTimeline{text, axis, {{text, {mark}}}, {span}},
                               MapBlock{map_picture({}, {}),
                                        {{text, SeriesColor::kTruth, {{{0, 0}, {1, 1}}}}},
                                        {{text, SeriesColor::kEvent, {0, 0}}}},
                               VideoBlock{text, "", text}, VideoBlock{"", text, text},
                               PictureBlock{.png = text, .caption = text}}}},
      .footer = text};
}

std::string html_of(const Block& block) {
  Page page;
  page.sections = {{.title = "", .blocks = {block}}};
  return to_html(page);
}

LinePlot plot_of(const Curve& curve) {
  LinePlot plot;
  plot.curves = {curve};
  return plot;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t num = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++num;
  return num;
}

TEST(ReportPage, NoTextOfARunBecomesMarkup) {
  const std::string hostile = to_html(page_of_everything(kHostile)), harmless = to_html(page_of_everything("x"));
  EXPECT_THAT(hostile, Not(HasSubstr("<img")));
  EXPECT_EQ(count(hostile, "</script>"), count(harmless, "</script>"));
  // Tables let long names break: that markup is ours.
  EXPECT_EQ(count(hostile, "<") - count(hostile, "<wbr>"), count(harmless, "<"));
}

TEST(ReportPage, IsTheSameBytesTwice) { EXPECT_EQ(to_html(page_of_everything("x")), to_html(page_of_everything("x"))); }

TEST(ReportPage, NamesNothingThatWouldBeFetched) {
  const std::string html = to_html(page_of_everything("x"));
  const std::regex address(R"re((?:src|href)="([^"#]*)")re");
  for (std::sregex_iterator found(html.begin(), html.end(), address), end; found != end; ++found) {
    const std::string target = (*found)[1];
    EXPECT_TRUE(target.starts_with("data:") || target == "x") << target.substr(0, 80);
  }
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, Not(HasSubstr("@import")));
  EXPECT_THAT(html, Not(HasSubstr("url(")));
}

TEST(ReportPage, CarriesItsStyleAndScripts) {
  const std::string html = to_html(Page{});
  EXPECT_THAT(html, HasSubstr("uPlot=function"));
  EXPECT_THAT(html, HasSubstr(".u-wrap"));
  EXPECT_THAT(html, HasSubstr("zoomableMap"));
  EXPECT_THAT(html, HasSubstr("@media print"));
}

TEST(ReportPage, SectionsAreReachedFromTheTop) {
  Page page;
  page.sections = {{.title = "Error over time", .blocks = {}}};
  const std::string html = to_html(page);
  EXPECT_THAT(html, HasSubstr("<a href=\"#error-over-time\">Error over time</a>"));
  EXPECT_THAT(html, HasSubstr("<section id=\"error-over-time\">"));
}

TEST(LinePlot, KeepsTheOnePeakOfALongCurveAndSaysThatItIsThinned) {
  const std::string html = html_of(plot_of(long_curve()));
  EXPECT_THAT(html, HasSubstr("12.5"));
  EXPECT_THAT(html, HasSubstr("min/max of 20000 samples"));
  EXPECT_LT(html.size(), 120'000u);
}

TEST(LinePlot, GoesLogarithmicWhenThePeakDwarfsTheRest) {
  Curve calm{.name = "calm", .points = {{0.0, 0.01}, {1.0, 0.02}, {2.0, 0.03}}}, wild = calm;
  wild.points.back().y() = 20.0;
  EXPECT_THAT(html_of(plot_of(calm)), HasSubstr("\"log\":false"));
  EXPECT_THAT(html_of(plot_of(wild)), HasSubstr("\"log\":true"));
  wild.points.front().y() = -1.0;  // a state, not an error: there is no logarithm of it
  EXPECT_THAT(html_of(plot_of(wild)), HasSubstr("\"log\":false"));
}

TEST(BoxPlot, StandsOnAScaleOfRoundTicks) {
  const BoxPlot plot{.caption = "c",
                     .unit = "cm",
                     .boxes = {{.label = "goal_1",
                                .values = {1.0, 2.0, 3.7},
                                .lower_quartile = 1.5,
                                .median = 2.0,
                                .upper_quartile = 2.85,
                                .text = "2.00"}}};
  const std::string html = html_of(plot);
  EXPECT_THAT(html, HasSubstr("left:100.000%\">4 cm"));  // ticks 0, 1, 2, 3, 4
  EXPECT_THAT(html, HasSubstr("class=\"median\" style=\"left:50.000%\""));
  EXPECT_THAT(html, HasSubstr("class=\"box\" style=\"left:37.500%;width:33.750%\""));
  EXPECT_THAT(html, HasSubstr("class=\"whisker\" style=\"left:25.000%;width:67.500%\""));
  EXPECT_EQ(count(html, "class=\"dot\""), 3u);
}

TEST(WaterfallChart, HasAScaleWithZeroAndNegativeValuesInIt) {
  const std::string html =
      html_of(WaterfallChart{"",
                             "cm",
                             {{.label = "a", .from = 0.0, .to = -2.0, .interval = std::pair(-3.0, -1.0), .text = ""},
                              {.label = "b", .from = 0.0, .to = 1.0, .text = ""}}});
  // -3 ... 1 in steps of 1: zero at three quarters; a from -2 to 0, its interval from -3 to -1.
  EXPECT_THAT(html, HasSubstr("zero\" style=\"left:75.000%"));
  EXPECT_THAT(html, HasSubstr("span plain\" style=\"left:25.000%;width:50.000%"));
  EXPECT_THAT(html, HasSubstr("whisker\" style=\"left:0.000%;width:50.000%"));
  EXPECT_THAT(html, HasSubstr(">1 cm<"));
}

}  // namespace
}  // namespace patrol::report::page_test
