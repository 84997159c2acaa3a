#include "render/scene/haze.h"

#include <cmath>
#include <cstdint>

namespace patrol::render {
namespace {

std::uint8_t mix(std::uint8_t thing, std::uint8_t haze, double transmittance) {
  return static_cast<std::uint8_t>(std::lround(haze + transmittance * (thing - haze)));
}

}  // namespace

void add_haze(Frame& frame, const std::vector<float>& depth, const View& view, const Haze& haze) {
  if (haze.extinction_per_m == 0.0) return;
  const Projector projector(view, frame.width(), frame.height());
  std::size_t pixel = 0;
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x, ++pixel) {
      const double along_axis_m = projector.distance_m(depth[pixel]) - view.near_m;
      const double off_axis =
          std::hypot(x + 0.5 - 0.5 * frame.width(), y + 0.5 - 0.5 * frame.height()) / projector.focal_px();
      const double transmittance =
          std::exp(-haze.extinction_per_m * along_axis_m * std::sqrt(1.0 + off_axis * off_axis));
      Color& color = frame.at(x, y);
      color = {mix(color.r, haze.color.r, transmittance), mix(color.g, haze.color.g, transmittance),
               mix(color.b, haze.color.b, transmittance)};
    }
  }
}

}  // namespace patrol::render
