#include "report/map_picture.h"

#include <numbers>

#include <gtest/gtest.h>

#include "render/scene/frame.h"
#include "tests/support/temporary_file.h"

namespace patrol::report::map_picture_test {
namespace {

using render::Frame;

const Color kPaper{255, 255, 255};
constexpr double kStepTol = 5.0;  // half a step of the palette is 2.6 mm, and the red grows by 1.7 a millimetre

Frame pixels_of(const MapPicture::Sheet& sheet) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "map.png", sheet.png);
  return render::load_png(folder / "map.png");
}
Frame pixels_of(const MapPicture& picture) { return pixels_of(picture.detail); }

Color color_at(const MapPicture& picture, const Frame& frame, double x_m, double y_m) {
  const double pixel_m = picture.detail.size_m.x() / frame.width();
  return frame.at(static_cast<int>((x_m - picture.low_m.x()) / pixel_m),
                  static_cast<int>((picture.high_m.y() - y_m) / pixel_m));
}

/// 4 m x 2 m of free floor in map, with one occupied cell at (3.05, 1.05) and its error.
MapLayers small_map(float error_m) {
  const GridGeometry geometry{.resolution_m = 0.1, .width = 40, .height = 20, .origin_m = {0.0, 0.0}};
  MapLayers layers{
      .built = OccupancyGrid(geometry, kFree), .T_world_map = {}, .truth = {}, .error_m = Grid<float>(geometry)};
  layers.built.at({30, 10}) = kOccupied;
  layers.error_m.at({30, 10}) = error_m;
  return layers;
}

TEST(MapPicture, ShowsAnOccupiedCellInTheColourOfItsError) {
  for (const float error_m : {0.0F, 0.1F, 0.2F, 5.0F}) {
    const MapPicture picture = map_picture(small_map(error_m), {});
    const Color shown = color_at(picture, pixels_of(picture), 3.05, 1.05), wanted = map_error_color(error_m);
    EXPECT_NEAR(shown.r, wanted.r, kStepTol) << error_m;
    EXPECT_NEAR(shown.g, wanted.g, kStepTol) << error_m;
    EXPECT_NEAR(shown.b, wanted.b, kStepTol) << error_m;
  }
}

TEST(MapPicture, IsNorthUpWithAMarginOfAMetre) {
  const MapPicture picture = map_picture(small_map(0.0F), {});
  const Frame frame = pixels_of(picture);
  EXPECT_NEAR(picture.low_m.x(), 0.05 - 1.0, 1e-9);  // centres of cells count as known
  EXPECT_NEAR(picture.low_m.y(), 0.05 - 1.0, 1e-9);
  EXPECT_EQ(color_at(picture, frame, 1.0, 1.0), kMapFree);
  EXPECT_EQ(color_at(picture, frame, -0.5, 1.0), kPaper);
  EXPECT_EQ(color_at(picture, frame, 1.0, 2.5), kPaper);
}

TEST(MapPicture, TurnsTheMapIntoWorld) {
  MapLayers layers = small_map(0.0F);
  layers.T_world_map = {10.0, 20.0, std::numbers::pi / 2.0};  // (3.05, 1.05) in map is (10 - 1.05, 20 + 3.05) in world
  const MapPicture picture = map_picture(layers, {});
  EXPECT_EQ(color_at(picture, pixels_of(picture), 8.95, 23.05), map_error_color(0.0));
}

TEST(MapPicture, LosesNoCellOfATurnedWall) {
  MapLayers layers = small_map(0.0F);
  for (int col = 0; col < 40; ++col) layers.built.at({col, 10}) = kOccupied;
  layers.T_world_map = {0.0, 0.0, 0.5};
  const MapPicture picture = map_picture(layers, {});
  const Frame frame = pixels_of(picture);
  for (int col = 0; col < 40; ++col) {
    const Eigen::Vector2d p = layers.T_world_map * layers.built.geometry().center_of({col, 10});
    EXPECT_EQ(color_at(picture, frame, p.x(), p.y()), map_error_color(0.0)) << col;
  }
}

TEST(MapPicture, ShowsTrueSurfacesWhereNothingWasMapped) {
  MapLayers layers = small_map(0.0F);
  OccupancyGrid truth({.resolution_m = 0.05, .width = 20, .height = 20, .origin_m = {6.0, 1.0}}, kFree);
  truth.at({10, 10}) = kOccupied;
  layers.truth = truth;
  const MapPicture picture = map_picture(layers, {});
  EXPECT_EQ(color_at(picture, pixels_of(picture), 6.525, 1.525), kMapTruth);
  EXPECT_NEAR(picture.high_m.x(), 7.525, 1e-9);  // the surface and a metre: free truth does not count
}

TEST(MapPicture, DrawsAWallBroadlyInTheOverview) {
  MapLayers layers = small_map(0.2F);
  const MapPicture picture =
      map_picture(layers, Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(400, 300)));  // 0.4 m a pixel
  const Frame frame = pixels_of(picture.overview);
  EXPECT_LE(frame.width(), 1150);
  EXPECT_LE(frame.height(), 750);
  int num_red = 0;
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) num_red += frame.at(x, y) == map_error_color(0.2) ? 1 : 0;
  }
  EXPECT_EQ(num_red, 4);
}

TEST(MapPicture, HasAtMostEightMillionPixels) {
  const GridGeometry geometry{.resolution_m = 0.05, .width = 4, .height = 4, .origin_m = {0.0, 0.0}};
  const MapLayers layers{.built = OccupancyGrid(geometry, kFree), .T_world_map = {}, .truth = {}, .error_m = {}};
  const Frame frame =
      pixels_of(map_picture(layers, Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(1000, 500))));
  EXPECT_LE(frame.width() * frame.height(), 8'020'000);
}

TEST(MapPicture, OfNothingIsABlankSheet) {
  const MapPicture picture = map_picture({}, {});
  EXPECT_EQ(pixels_of(picture).at(0, 0), kPaper);
}

TEST(MapErrorColor, GrowsLighterFromEndToEnd) {
  const auto lightness = [](Color color) { return 0.3 * color.r + 0.59 * color.g + 0.11 * color.b; };
  for (double error_m = 0.01; error_m <= kMapErrorEnd_m; error_m += 0.01) {
    EXPECT_GT(lightness(map_error_color(error_m)), lightness(map_error_color(error_m - 0.01))) << error_m;
  }
  EXPECT_EQ(map_error_color(3.0), map_error_color(kMapErrorEnd_m));
}

}  // namespace
}  // namespace patrol::report::map_picture_test
