#include "io/maps/map_png.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <png.h>

namespace patrol::io::map_png_test {
namespace {

TEST(MapPng, HasNorthUpAndTheThreeGreysOfMapServer) {
  OccupancyGrid map({.resolution_m = 0.1, .width = 3, .height = 2, .origin_m = {0.0, 0.0}}, kUnknown);
  map.at({0, 0}) = kOccupied;  // bottom left
  map.at({2, 1}) = kFree;      // top right
  const std::string png = map_png(map);

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, png.data(), png.size()), 0);
  image.format = PNG_FORMAT_GRAY;
  std::vector<std::uint8_t> pixels(6);
  ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  EXPECT_EQ(image.width, 3U);
  EXPECT_EQ(pixels, (std::vector<std::uint8_t>{205, 205, 254, 0, 205, 205}));
}

}  // namespace
}  // namespace patrol::io::map_png_test
