#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <Eigen/Core>

#include "render/frame.h"

namespace patrol::render {

struct Brush {
  Color color;
  double opacity = 1.0;
};

inline Color blend(Color below, Color above, double opacity) {
  const auto mix = [&](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(a + opacity * (b - a) + 0.5);
  };
  return {mix(below.r, above.r), mix(below.g, above.g), mix(below.b, above.b)};
}

/// Letters of one size.
class Font {
 public:
  /// DejaVu Sans from where Linux distributions keep it. Throws InputError, naming the package, when it is
  /// not there.
  explicit Font(int height_px, bool is_bold = false);
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  int height_px() const { return height_px_; }
  /// UTF-8; `left`, `baseline`: where the first letter stands. Returns where the next one would.
  int draw(Frame& frame, int left, int baseline, const std::string& text, const Brush& brush);
  int width_px(const std::string& text);
  /// As much of the text as fits, with an ellipsis where it was cut.
  std::string fitted(const std::string& text, int width_px);

 private:
  struct Face;
  std::unique_ptr<Face> face_;
  int height_px_;
};

/// Flat drawing on a frame; what lies outside is cut off. Pixel centres are at .5.
void fill_rectangle(Frame& frame, int left, int top, int width, int height, const Brush& brush);
void draw_line(Frame& frame, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_px,
               const Brush& brush);
/// `picture` with its upper left corner at (left, top).
void paste(Frame& frame, int left, int top, const Frame& picture);
void draw_disc(Frame& frame, const Eigen::Vector2d& center, double radius_px, const Brush& brush);

}  // namespace patrol::render
