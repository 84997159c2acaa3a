#include "render/map_inset.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include "render/scene/palette.h"

namespace patrol::render {
namespace {

constexpr Color kUnknownCell{44, 48, 56};
constexpr Color kFreeCell{214, 218, 222};
constexpr Color kOccupiedCell{16, 18, 24};
constexpr Color kBorderColor{235, 238, 242};

/// Bounding box of the known cells, in world.
Eigen::AlignedBox2d known_bounds(const OccupancyGrid& map, const Pose2& T_world_map) {
  const GridGeometry& geometry = map.geometry();
  Cell low{geometry.width, geometry.height}, high{-1, -1};
  for (int row = 0; row < geometry.height; ++row) {
    const std::int8_t* cells = &map.at({0, row});
    const auto is_known = [](std::int8_t value) { return value != kUnknown; };
    const int first = static_cast<int>(std::find_if(cells, cells + geometry.width, is_known) - cells);
    if (first == geometry.width) continue;
    int last = geometry.width - 1;
    while (!is_known(cells[last])) --last;
    low = {std::min(low.col, first), std::min(low.row, row)};
    high = {std::max(high.col, last), row};
  }
  Eigen::AlignedBox2d box;
  if (high.col < 0) return box;
  for (const Cell corner : {low, high, Cell{low.col, high.row}, Cell{high.col, low.row}}) {
    box.extend(T_world_map * geometry.center_of(corner));
  }
  return box;
}

}  // namespace

void MapInset::draw(Frame& frame, const RunSnapshot& snapshot) {
  if (!snapshot.map) return;
  if (snapshot.map != map_) update_picture(frame, snapshot);
  if (picture_.width() == 0) return;

  const double scale = frame.height() / 720.0;  // line width scale
  Frame inset = picture_;
  for (const Eigen::Vector3d& hit : snapshot.scan) {
    const Eigen::Vector2d p = pixel_of(hit.head<2>());
    draw_disc(inset, p, 0.8 * scale, {kScanColor, 0.9});
  }
  const auto draw_path = [&](std::span<const Eigen::Vector3d> path, double width_px, Color color) {
    constexpr double kStep_px = 1.5;
    for (std::size_t from = 0, to = 1; to < path.size(); ++to) {
      const Eigen::Vector2d a = pixel_of(path[from].head<2>()), b = pixel_of(path[to].head<2>());
      if ((b - a).norm() < kStep_px && to + 1 < path.size()) continue;
      draw_line(inset, a, b, width_px * scale, {color, 1.0});
      from = to;
    }
  };
  draw_path(snapshot.planned_path, 1.5, kPlanColor);
  draw_path(snapshot.true_path, 2.5, kTruthColor);
  draw_path(snapshot.estimated_path, 1.5, kEstimateColor);
  for (const Pose2& T_map_body : snapshot.particles) {
    draw_disc(inset, pixel_of(snapshot.T_world_map * T_map_body.position()), 1.5 * scale, {kParticleColor, 0.7});
  }
  const auto draw_robot = [&](const Pose2& T_world_body, double size, Color color) {
    const Eigen::Vector2d middle = pixel_of(T_world_body.position());
    const Eigen::Vector2d ahead(std::cos(T_world_body.yaw), -std::sin(T_world_body.yaw));
    draw_line(inset, middle - 5.0 * size * ahead, middle + 10.0 * size * ahead, 3.0 * size, {color, 1.0});
    draw_disc(inset, middle, 4.5 * size, {color, 1.0});
  };
  draw_robot(to_pose2(snapshot.T_world_body), 1.25 * scale, kTruthColor);
  if (snapshot.T_map_body) draw_robot(snapshot.T_world_map * *snapshot.T_map_body, scale, kRobotColor);

  const int margin = static_cast<int>(std::lround(16 * scale)),
            border = std::max(1, static_cast<int>(std::lround(2 * scale)));
  const int left = frame.width() - inset.width() - margin, top = frame.height() - inset.height() - margin;
  fill_rectangle(frame, left - border, top - border, inset.width() + 2 * border, inset.height() + 2 * border,
                 {kBorderColor, 0.8});
  paste(frame, left, top, inset);
}

// Paints the pixel of every occupied cell, so that walls of one cell stay visible at any scale.
void MapInset::update_picture(const Frame& frame, const RunSnapshot& snapshot) {
  constexpr double kMaxWidth = 0.28, kMaxHeight = 0.52, kMaxStripWidth = 0.42;  // fractions of the frame
  constexpr double kStrip = 4.0;  // aspect ratio above which a map may be wider, because it is low
  constexpr double kMargin_m = 1.0;
  map_ = snapshot.map;
  Eigen::AlignedBox2d shown = known_bounds(*map_, snapshot.T_world_map);
  picture_ = Frame();
  if (shown.isEmpty()) return;
  shown.min().array() -= kMargin_m;
  shown.max().array() += kMargin_m;
  low_m_ = shown.min();
  high_m_ = shown.max();
  const Eigen::Vector2d size_m = shown.sizes();
  const double max_width = size_m.x() > kStrip * size_m.y() ? kMaxStripWidth : kMaxWidth;
  px_per_m_ = std::min({max_width * frame.width() / size_m.x(), kMaxHeight * frame.height() / size_m.y(),
                        1.0 / map_->geometry().resolution_m});
  const int width = static_cast<int>(std::ceil(size_m.x() * px_per_m_));
  const int height = static_cast<int>(std::ceil(size_m.y() * px_per_m_));

  picture_ = Frame(width, height, kUnknownCell);
  const Pose2 T_map_world = snapshot.T_world_map.inverse();
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Eigen::Vector2d p_world(low_m_.x() + (x + 0.5) / px_per_m_, high_m_.y() - (y + 0.5) / px_per_m_);
      const Cell cell = map_->geometry().cell_at(T_map_world * p_world);
      if (map_->contains(cell) && map_->at(cell) != kUnknown) picture_.at(x, y) = kFreeCell;
    }
  }
  for (int row = 0; row < map_->geometry().height; ++row) {
    const std::int8_t* cells = &map_->at({0, row});
    for (int col = 0; col < map_->geometry().width; ++col) {
      if (cells[col] <= kOccupied / 2) continue;
      const Eigen::Vector2d p = pixel_of(snapshot.T_world_map * map_->geometry().center_of({col, row}));
      const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
      if (picture_.contains(x, y)) picture_.at(x, y) = kOccupiedCell;
    }
  }
}

Eigen::Vector2d MapInset::pixel_of(const Eigen::Vector2d& p_world_m) const {
  return px_per_m_ * Eigen::Vector2d(p_world_m.x() - low_m_.x(), high_m_.y() - p_world_m.y());
}

}  // namespace patrol::render
