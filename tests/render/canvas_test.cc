#include "render/canvas.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "render/scene/antialias.h"

namespace patrol::render::canvas_test {
namespace {

constexpr Brush kWhite{{255, 255, 255}, 1.0};

/// Painted area in pixels: white on black, shades counted by how white they are.
double painted_area(const Frame& frame) {
  double sum = 0.0;
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) sum += frame.at(x, y).r / 255.0;
  }
  return sum;
}

TEST(Canvas, ALineCoversItsLengthTimesItsWidth) {
  Frame frame(100, 100);
  draw_line(frame, {20.0, 30.0}, {70.0, 30.0}, 4.0, kWhite);
  // 50 px of line, and a half disc of radius 2 at both ends.
  EXPECT_NEAR(painted_area(frame), 50.0 * 4.0 + std::numbers::pi * 4.0, 2.0);
}

TEST(Canvas, ASlantedLineCoversAsMuchAsALevelOne) {
  Frame frame(100, 100);
  draw_line(frame, {20.0, 20.0}, {20.0 + 50.0 / std::numbers::sqrt2, 20.0 + 50.0 / std::numbers::sqrt2}, 4.0, kWhite);
  EXPECT_NEAR(painted_area(frame), 50.0 * 4.0 + std::numbers::pi * 4.0, 4.0);
}

TEST(Canvas, ADiscCoversPiRSquared) {
  Frame frame(60, 60);
  draw_disc(frame, {30.0, 30.0}, 12.0, kWhite);
  EXPECT_NEAR(painted_area(frame), std::numbers::pi * 144.0, 2.0);
}

TEST(Canvas, CutsOffWhatLiesOutside) {
  Frame frame(20, 20);
  draw_line(frame, {-1000.0, 10.0}, {1000.0, 10.0}, 2.0, kWhite);
  EXPECT_NEAR(painted_area(frame), 40.0, 0.5);
  fill_rectangle(frame, -5, -5, 100, 100, kWhite);
  EXPECT_NEAR(painted_area(frame), 400.0, 0.1);
}

TEST(Canvas, HalfAnInkGivesHalfTheColour) {
  EXPECT_EQ(blend({0, 100, 200}, {100, 100, 100}, 0.5), (Color{50, 100, 150}));
}

TEST(FontTest, DrawsAsWideAsItSays) {
  Font font(20);
  Frame frame(400, 40);
  const int end = font.draw(frame, 10, 30, "heading error 0.42°", kWhite);
  EXPECT_EQ(end, 10 + font.width_px("heading error 0.42°"));
  EXPECT_GT(painted_area(frame), 200.0);
}

TEST(FontTest, CutsALongTextAndSaysSo) {
  Font font(20);
  const std::string text = "The robot walked to the second regulator box.";
  const std::string cut = font.fitted(text, 200);
  EXPECT_LE(font.width_px(cut), 200);
  EXPECT_TRUE(cut.ends_with("…"));
  EXPECT_EQ(font.fitted("short", 200), "short");
}

TEST(SmoothEdges, LeavesFlatColourAlone) {
  Frame frame(16, 16, {40, 80, 120});
  smooth_edges(frame);
  EXPECT_EQ(frame, Frame(16, 16, {40, 80, 120}));
}

TEST(SmoothEdges, MakesTheStairsOfASlantedEdgeShallower) {
  // Rises one pixel in eight.
  Frame frame(64, 32);
  for (int x = 0; x < 64; ++x) {
    for (int y = 0; y < 10 + x / 8; ++y) frame.at(x, y) = {255, 255, 255};
  }
  const auto roughness = [](const Frame& of) {  // squared distance of each column's painted height from the true slope
    double sum = 0.0;
    for (int x = 8; x < 56; ++x) {
      double painted = 0.0;
      for (int y = 0; y < 32; ++y) painted += of.at(x, y).r / 255.0;
      sum += std::pow(painted - (9.5 + (x + 0.5) / 8.0), 2);
    }
    return sum;
  };
  const double before = roughness(frame);
  smooth_edges(frame);
  EXPECT_LT(roughness(frame), 0.75 * before);
}

}  // namespace
}  // namespace patrol::render::canvas_test
