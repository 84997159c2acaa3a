#include "render/antialias.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace patrol::render {
namespace {

constexpr float kMinContrast = 12.0f;        // of 255: below, no eye sees stairs
constexpr float kRelativeContrast = 0.125f;  // of the brightest neighbour
constexpr float kReach_px = 6.0f;            // along the edge

struct Tint {
  float r, g, b;
};

float luma(float r, float g, float b) { return 0.299f * r + 0.587f * g + 0.114f * b; }

/// Bilinear, at pixel coordinates where integers are pixel centres.
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

}  // namespace

void smooth_edges(Frame& frame) {
  const int width = frame.width(), height = frame.height();
  if (width < 3 || height < 3) return;
  const auto row = static_cast<std::size_t>(width);
  std::vector<float> light(row * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Color& pixel = frame.at(x, y);
      light[static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x)] = luma(pixel.r, pixel.g, pixel.b);
    }
  }
  const Frame sharp = frame;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const float* here = light.data() + static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
      const float nw = here[-static_cast<std::ptrdiff_t>(row) - 1], ne = here[-static_cast<std::ptrdiff_t>(row) + 1];
      const float sw = here[row - 1], se = here[row + 1];
      const float darkest = std::min({nw, ne, sw, se, here[0]}), brightest = std::max({nw, ne, sw, se, here[0]});
      if (brightest - darkest < std::max(kMinContrast, kRelativeContrast * brightest)) continue;

      // Along the edge: across the gradient.
      float dx = (sw + se) - (nw + ne), dy = (nw + sw) - (ne + se);
      const float scale = 1.0f / (std::min(std::abs(dx), std::abs(dy)) + 0.03125f * (nw + ne + sw + se) + 0.5f);
      dx = std::clamp(dx * scale, -kReach_px, kReach_px);
      dy = std::clamp(dy * scale, -kReach_px, kReach_px);
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      const Tint near = mean(sample(sharp, fx - dx / 6, fy - dy / 6), sample(sharp, fx + dx / 6, fy + dy / 6));
      const Tint far = mean(sample(sharp, fx - dx / 2, fy - dy / 2), sample(sharp, fx + dx / 2, fy + dy / 2));
      const Tint both = mean(near, far);
      const float both_light = luma(both.r, both.g, both.b);
      const Tint& chosen = both_light < darkest || both_light > brightest ? near : both;
      frame.at(x, y) = {static_cast<std::uint8_t>(chosen.r + 0.5f), static_cast<std::uint8_t>(chosen.g + 0.5f),
                        static_cast<std::uint8_t>(chosen.b + 0.5f)};
    }
  }
}

}  // namespace patrol::render
