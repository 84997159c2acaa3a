#include "render/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "render/canvas.h"

namespace patrol::render {
namespace {

constexpr Color kPaper{255, 255, 255}, kSurface{22, 34, 48}, kWriting{40, 48, 58}, kStroke{200, 30, 60};
constexpr int kFooter_px = 92, kEdge_px = 16;

class Sheet {
 public:
  Sheet(const HeatMap& map, int max_width_px) : map_(map) {
    for (const HeatMap::Sample& sample : map.positions) shown_.extend(sample.p_m);
    constexpr double kMargin_m = 1.5;
    shown_.min().array() -= kMargin_m;
    shown_.max().array() += kMargin_m;
    constexpr double kMaxHeight_px = 1100.0;
    px_per_m_ = std::min({max_width_px / shown_.sizes().x(), kMaxHeight_px / shown_.sizes().y(),
                          1.0 / map.surfaces.geometry().resolution_m});
    picture_height_px_ = static_cast<int>(std::ceil(px_per_m_ * shown_.sizes().y()));
    constexpr int kMinWidth_px = 640;  // minimum width for the color scale
    frame_ = Frame(std::max(static_cast<int>(std::ceil(px_per_m_ * shown_.sizes().x())), kMinWidth_px),
                   picture_height_px_ + kFooter_px, kPaper);
  }

  Frame draw() {
    draw_values();
    draw_surfaces();
    draw_strokes();
    draw_scale();
    return std::move(frame_);
  }

 private:
  Eigen::Vector2d pixel_of(const Eigen::Vector2d& p_m) const {
    return px_per_m_ * Eigen::Vector2d(p_m.x() - shown_.min().x(), shown_.max().y() - p_m.y());
  }

  void draw_values() {
    const int side_px = std::max(1, static_cast<int>(std::ceil(px_per_m_ * map_.step_m)));
    for (const HeatMap::Sample& sample : map_.positions) {
      const Eigen::Vector2d corner = pixel_of(sample.p_m + 0.5 * map_.step_m * Eigen::Vector2d(-1.0, 1.0));
      fill_rectangle(frame_, static_cast<int>(std::lround(corner.x())), static_cast<int>(std::lround(corner.y())),
                     side_px, side_px, {heat_color(sample.color_fraction)});
    }
  }

  void draw_surfaces() {
    const GridGeometry& geometry = map_.surfaces.geometry();
    for (int row = 0; row < geometry.height; ++row) {
      for (int col = 0; col < geometry.width; ++col) {
        if (map_.surfaces.at({col, row}) <= kFree) continue;
        const Eigen::Vector2d pixel = pixel_of(geometry.center_of({col, row}));
        const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
        if (pixel.x() >= 0.0 && y < picture_height_px_ && frame_.contains(x, y)) frame_.at(x, y) = kSurface;
      }
    }
  }

  void draw_strokes() {
    for (const HeatMap::Sample& sample : map_.positions) {
      if (!sample.has_stroke) continue;
      const Eigen::Vector2d half =
          0.42 * map_.step_m * Eigen::Vector2d(std::cos(sample.stroke_rad), std::sin(sample.stroke_rad));
      draw_line(frame_, pixel_of(sample.p_m - half), pixel_of(sample.p_m + half), 1.4, {kStroke});
    }
  }

  void draw_scale() {
    constexpr int kBarTop_px = 48, kBarHeight_px = 12, kBarWidth_px = 420;
    Font title(15, true), small(12);
    const int top = picture_height_px_;
    title.draw(frame_, kEdge_px, top + 20, map_.title, {kWriting});
    small.draw(frame_, kEdge_px, top + 38, small.fitted(map_.note, frame_.width() - 2 * kEdge_px), {kWriting});
    for (int x = 0; x < kBarWidth_px; ++x) {
      fill_rectangle(frame_, kEdge_px + x, top + kBarTop_px, 1, kBarHeight_px,
                     {heat_color(static_cast<double>(x) / (kBarWidth_px - 1))});
    }
    for (const HeatMap::Tick& tick : map_.scale) {
      const int x = kEdge_px + static_cast<int>(std::lround(tick.color_fraction * (kBarWidth_px - 1)));
      fill_rectangle(frame_, x, top + kBarTop_px + kBarHeight_px, 1, 4, {kWriting});
      small.draw(frame_, std::max(kEdge_px, x - small.width_px(tick.text) / 2), top + kBarTop_px + kBarHeight_px + 18,
                 tick.text, {kWriting});
    }
  }

  const HeatMap& map_;
  Eigen::AlignedBox2d shown_;
  double px_per_m_ = 1.0;
  int picture_height_px_ = 0;
  Frame frame_;
};

}  // namespace

Color heat_color(double color_fraction) {
  struct Stop {
    double r, g, b;
  };
  static constexpr std::array<Stop, 5> kStops = {
      {{38, 42, 92}, {36, 104, 142}, {44, 160, 132}, {134, 204, 84}, {252, 230, 60}}};
  const double position = std::clamp(color_fraction, 0.0, 1.0) * (kStops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
  const double fraction = position - static_cast<double>(below);
  const auto mix = [&](double a, double b) { return static_cast<std::uint8_t>(std::lround(a + fraction * (b - a))); };
  return {mix(kStops[below].r, kStops[below + 1].r), mix(kStops[below].g, kStops[below + 1].g),
          mix(kStops[below].b, kStops[below + 1].b)};
}

Frame draw_heat_map(const HeatMap& map, int max_width_px) { return Sheet(map, max_width_px).draw(); }

}  // namespace patrol::render
