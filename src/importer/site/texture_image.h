#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace patrol::importer {

/// Picture: RGB, 8 bits per channel, row 0 at the top, without padding.
struct TextureImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb = {};
};

/// Decodes a picture (PNG, JPEG, BMP, GIF, TIFF, WebP or TGA, told apart by their first bytes, TGA by `extension`) by
/// libavcodec. Pictures with a side above `max_side` are reduced to it. None if it cannot be decoded.
std::optional<TextureImage> decode_image(std::string_view bytes, const std::string& extension, int max_side = 4096);

/// Encodes a picture as PNG, the only compressed form that MuJoCo reads. Throws std::runtime_error if that fails.
std::string encode_png(const TextureImage& image);

/// Returns the mean color, each channel in [0, 1].
Eigen::Vector3d mean_color(const TextureImage& image);

}  // namespace patrol::importer
