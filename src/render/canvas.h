#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <Eigen/Core>

#include "render/scene/frame.h"

namespace patrol::render {

/// Color and opacity of a drawing operation, 0 transparent ... 1 opaque.
struct Brush {
  Color color;
  double opacity = 1.0;
};

/// Color of `above` with `opacity` over `below`.
inline Color blend(Color below, Color above, double opacity) {
  const auto mix = [&](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + opacity * (b - a)));
  };
  return {mix(below.r, above.r), mix(below.g, above.g), mix(below.b, above.b)};
}

/// Font of one size.
class Font {
 public:
  /// Loads DejaVu Sans from the font directories of Linux distributions. Throws InputError with the package name when
  /// the font is not installed.
  explicit Font(int height_px, bool is_bold = false);
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  int height_px() const { return height_px_; }
  /// Draws UTF-8 text. `left` and `baseline` are the origin of the first letter. Returns the origin of the next letter.
  int draw(Frame& frame, int left, int baseline, const std::string& text, const Brush& brush);
  /// Width of the text, px.
  int width_px(const std::string& text);
  /// Longest prefix of the text that fits, with an ellipsis when it was cut.
  std::string fitted(const std::string& text, int width_px);

 private:
  struct Face;
  std::unique_ptr<Face> face_;
  int height_px_;
};

/// 2D drawing on a frame, clipped to the frame. Pixel centers are at .5.
void fill_rectangle(Frame& frame, int left, int top, int width, int height, const Brush& brush);
void draw_line(Frame& frame, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_px,
               const Brush& brush);
/// Copies `picture` with its upper left corner to (left, top).
void paste(Frame& frame, int left, int top, const Frame& picture);
void draw_disc(Frame& frame, const Eigen::Vector2d& center, double radius_px, const Brush& brush);

}  // namespace patrol::render
