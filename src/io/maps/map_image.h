#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace patrol::io {

/// Image of a map: [row from the top * width + column].
struct MapImage {
  int width = 0, height = 0;
  std::uint32_t maximum = 255;            ///< largest value of a channel
  std::vector<std::uint32_t> brightness;  ///< sum of red, green and blue; a gray value counts three times
  std::vector<std::uint16_t> opacity;     ///< alpha channel; empty if the image has none
};

/// Reads a PGM (P5 or P2, 8 or 16 bits, any largest gray value) or a PNG (gray, RGB or palette, 1 to 16 bits, with or
/// without alpha). The first bytes tell them apart. Values of a PNG are taken as they are: gamma and color profiles are
/// ignored. Throws InputError.
MapImage load_map_image(const std::filesystem::path& file);

}  // namespace patrol::io
