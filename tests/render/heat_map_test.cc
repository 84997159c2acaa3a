#include "render/heat_map.h"

#include <gtest/gtest.h>

namespace patrol::render::heat_map_test {
namespace {

TEST(HeatMap, LightnessGrowsWithTheFigure) {
  double before = -1.0;
  for (double color_fraction = 0.0; color_fraction <= 1.0; color_fraction += 0.05) {
    const Color color = heat_color(color_fraction);
    const double lightness = 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
    EXPECT_GT(lightness, before);
    before = lightness;
  }
}

TEST(HeatMap, APlaceHasItsColourAndASurfaceIsDark) {
  OccupancyGrid surfaces({.resolution_m = 0.1, .width = 100, .height = 100, .origin_m = {0.0, 0.0}}, kFree);
  for (int row = 0; row < 100; ++row) surfaces.at({80, row}) = kOccupied;
  const HeatMap map{
      .surfaces = surfaces,
      .step_m = 1.0,
      .positions = {{.p_m = {5.0, 5.0}, .color_fraction = 1.0}, {.p_m = {7.0, 5.0}, .color_fraction = 0.0}},
      .title = "",
      .note = "",
      .scale = {}};
  const Frame frame = draw_heat_map(map);
  // The picture begins 1.5 m beside the places: 10 pixels a metre, x from 3.5 m, y down from 6.5 m.
  EXPECT_EQ(frame.at(15, 15), heat_color(1.0));
  EXPECT_EQ(frame.at(35, 15), heat_color(0.0));
  EXPECT_EQ(frame.at(45, 10), (Color{22, 34, 48}));
}

}  // namespace
}  // namespace patrol::render::heat_map_test
