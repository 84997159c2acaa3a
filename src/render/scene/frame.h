#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/color.h"

namespace patrol::render {

/// Picture: RGB, 8 bits per channel, row 0 at the top.
class Frame {
 public:
  Frame() = default;
  Frame(int width, int height, Color fill = {})
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {}

  int width() const { return width_; }
  int height() const { return height_; }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  Color& at(int x, int y) { return pixels_[index(x, y)]; }
  const Color& at(int x, int y) const { return pixels_[index(x, y)]; }
  /// Pixel data: three bytes per pixel, no padding.
  std::uint8_t* bytes() { return reinterpret_cast<std::uint8_t*>(pixels_.data()); }
  const std::uint8_t* bytes() const { return reinterpret_cast<const std::uint8_t*>(pixels_.data()); }

  friend bool operator==(const Frame&, const Frame&) = default;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_ = 0;
  int height_ = 0;
  std::vector<Color> pixels_;
};

/// Encodes a picture as PNG. Throws std::runtime_error if that fails.
std::string to_png(const Frame& frame);

/// Saves or loads a PNG. Throws InputError when the file cannot be written, or cannot be read as a PNG.
void save_png(const std::filesystem::path& file, const Frame& frame);
Frame load_png(const std::filesystem::path& file);

}  // namespace patrol::render
