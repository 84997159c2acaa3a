#include "io/maps/map_png.h"

#include <cstdint>
#include <stdexcept>
#include <vector>

#include <png.h>

namespace patrol::io {
namespace {

std::uint8_t to_gray(std::int8_t occupancy) {
  if (occupancy == kUnknown) return 205;
  return occupancy >= 50 ? 0 : 254;
}

}  // namespace

std::string map_png(const OccupancyGrid& map) {
  const GridGeometry& geometry = map.geometry();
  std::vector<std::uint8_t> pixels;
  pixels.reserve(geometry.size());
  for (int row = geometry.height - 1; row >= 0; --row) {
    for (int col = 0; col < geometry.width; ++col) pixels.push_back(to_gray(map.at({col, row})));
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.format = PNG_FORMAT_GRAY;
  image.width = static_cast<png_uint_32>(geometry.width);
  image.height = static_cast<png_uint_32>(geometry.height);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string png(size, '\0');
  if (png_image_write_to_memory(&image, png.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
    throw std::runtime_error(image.message);
  png.resize(size);
  return png;
}

}  // namespace patrol::io
