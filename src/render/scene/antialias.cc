#include "render/scene/antialias.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace patrol::render {
namespace {

constexpr int kMinContrast = 16;           // brightness step, of 255; weaker steps are not visible
constexpr int kBrightnessPerContrast = 5;  // minimum contrast: a fifth of the brightest neighbor
constexpr float kReach_px = 6.0f;          // maximum blur length along the edge

struct Tint {
  float r, g, b;
};

/// Bilinear interpolation. Integer coordinates are pixel centers.
Tint sample(const Frame& frame, float x, float y) {
  x = std::clamp(x, 0.0f, static_cast<float>(frame.width() - 1) - 0.001f);
  y = std::clamp(y, 0.0f, static_cast<float>(frame.height() - 1) - 0.001f);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const float u = x - static_cast<float>(left), v = y - static_cast<float>(top);
  const Color &a = frame.at(left, top), &b = frame.at(left + 1, top);
  const Color &c = frame.at(left, top + 1), &d = frame.at(left + 1, top + 1);
  const auto mix = [&](float p, float q, float r, float s) {
    return (1 - v) * ((1 - u) * p + u * q) + v * ((1 - u) * r + u * s);
  };
  return {mix(a.r, b.r, c.r, d.r), mix(a.g, b.g, c.g, d.g), mix(a.b, b.b, c.b, d.b)};
}

Tint mean(const Tint& a, const Tint& b) { return {0.5f * (a.r + b.r), 0.5f * (a.g + b.g), 0.5f * (a.b + b.b)}; }

/// Brightness of each pixel, 0 ... 255.
std::vector<std::int16_t> brightness_of(const Frame& frame) {
  std::vector<std::int16_t> light(static_cast<std::size_t>(frame.width()) * static_cast<std::size_t>(frame.height()));
  const std::uint8_t* rgb = frame.bytes();
  for (std::size_t i = 0; i < light.size(); ++i) {
    light[i] = static_cast<std::int16_t>((77 * rgb[3 * i] + 150 * rgb[3 * i + 1] + 29 * rgb[3 * i + 2]) >> 8);
  }
  return light;
}

/// Marks the brightness steps of one row. `above`, `here` and `below` are the brightness of adjacent rows. Branch-free
/// arithmetic, for vectorization by the compiler.
void mark_edges(const std::int16_t* above, const std::int16_t* here, const std::int16_t* below, int width,
                std::int16_t* is_edge) {
  for (int x = 1; x + 1 < width; ++x) {
    const auto darkest =
        std::min(std::min(std::min(above[x - 1], above[x + 1]), std::min(below[x - 1], below[x + 1])), here[x]);
    const auto brightest =
        std::max(std::max(std::max(above[x - 1], above[x + 1]), std::max(below[x - 1], below[x + 1])), here[x]);
    const int contrast = brightest - darkest;
    is_edge[x] = static_cast<std::int16_t>((contrast >= kMinContrast ? 1 : 0) &
                                           (kBrightnessPerContrast * contrast >= brightest ? 1 : 0));
  }
}

/// Color of a pixel after blurring along its edge, perpendicular to the brightness gradient.
Color blurred_along_edge(const Frame& sharp, int x, int y, const std::int16_t* above, const std::int16_t* here,
                         const std::int16_t* below) {
  const float nw = above[x - 1], ne = above[x + 1], sw = below[x - 1], se = below[x + 1];
  float dx = (sw + se) - (nw + ne), dy = (nw + sw) - (ne + se);
  const float scale = 1.0f / (std::min(std::abs(dx), std::abs(dy)) + 0.03125f * (nw + ne + sw + se) + 0.5f);
  dx = std::clamp(dx * scale, -kReach_px, kReach_px);
  dy = std::clamp(dy * scale, -kReach_px, kReach_px);
  const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
  const Tint near = mean(sample(sharp, fx - dx / 6, fy - dy / 6), sample(sharp, fx + dx / 6, fy + dy / 6));
  const Tint far = mean(sample(sharp, fx - dx / 2, fy - dy / 2), sample(sharp, fx + dx / 2, fy + dy / 2));
  const Tint both = mean(near, far);
  // A value outside the range of the neighborhood was sampled beyond the edge: use the shorter blur.
  const float light = (77.0f * both.r + 150.0f * both.g + 29.0f * both.b) / 256.0f;
  const float middle = here[x];
  const bool is_beyond = light < std::min({nw, ne, sw, se, middle}) || light > std::max({nw, ne, sw, se, middle});
  const Tint& chosen = is_beyond ? near : both;
  const auto rounded = [](float value) { return static_cast<std::uint8_t>(std::lround(value)); };
  return {rounded(chosen.r), rounded(chosen.g), rounded(chosen.b)};
}

}  // namespace

void smooth_edges(Frame& frame) {
  const int width = frame.width(), height = frame.height();
  if (width < 3 || height < 3) return;
  const std::vector<std::int16_t> light = brightness_of(frame);
  const Frame sharp = frame;
  std::vector<std::int16_t> is_edge(static_cast<std::size_t>(width));
  for (int y = 1; y + 1 < height; ++y) {
    const std::int16_t* here = light.data() + static_cast<std::ptrdiff_t>(y) * width;
    const std::int16_t *above = here - width, *below = here + width;
    mark_edges(above, here, below, width, is_edge.data());
    for (int x = 1; x + 1 < width; ++x) {
      if (is_edge[static_cast<std::size_t>(x)] != 0)
        frame.at(x, y) = blurred_along_edge(sharp, x, y, above, here, below);
    }
  }
}

}  // namespace patrol::render
