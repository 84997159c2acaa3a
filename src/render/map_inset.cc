#include "render/map_inset.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "render/palette.h"

namespace patrol::render {
namespace {

constexpr Color kNothing{44, 48, 56};
constexpr Color kFreeCell{214, 218, 222};
constexpr Color kOccupiedCell{16, 18, 24};

/// The corners of what the map knows, in world.
Eigen::AlignedBox2d known_part(const OccupancyGrid& map, const Pose2& T_world_map) {
  Cell low{map.geometry().width, map.geometry().height}, high{-1, -1};
  for (int row = 0; row < map.geometry().height; ++row) {
    for (int col = 0; col < map.geometry().width; ++col) {
      if (map.at({col, row}) == kUnknown) continue;
      low = {std::min(low.col, col), std::min(low.row, row)};
      high = {std::max(high.col, col), std::max(high.row, row)};
    }
  }
  Eigen::AlignedBox2d box;
  if (high.col < 0) return box;
  for (const Cell corner : {low, high, Cell{low.col, high.row}, Cell{high.col, low.row}}) {
    box.extend(T_world_map * map.geometry().center_of(corner));
  }
  return box;
}

}  // namespace

void MapInset::draw(Frame& frame, const RunSnapshot& snapshot) {
  if (!snapshot.map) return;
  if (snapshot.map != map_) lay_out(frame, snapshot);
  if (picture_.width() == 0) return;
  draw_map(frame);

  const auto draw_path = [&](std::span<const Eigen::Vector3d> path, double width_px, Color color) {
    for (std::size_t i = 1; i < path.size(); ++i) {
      draw_line(frame, pixel_of(path[i - 1].head<2>()), pixel_of(path[i].head<2>()), width_px, {color, 1.0});
    }
  };
  draw_path(snapshot.planned_path, 1.5, kPlanColor);
  draw_path(snapshot.true_path, 2.5, kTruthColor);
  draw_path(snapshot.estimated_path, 1.5, kEstimateColor);
  for (const Pose2& T_map_body : snapshot.particles) {
    draw_disc(frame, pixel_of(snapshot.T_world_map * T_map_body.position()), 1.5, {kParticleColor, 0.7});
  }
  const Pose2 T_world_estimate = snapshot.T_world_map * snapshot.T_map_body;
  const Eigen::Vector2d robot = pixel_of(T_world_estimate.position());
  const Eigen::Vector2d ahead(std::cos(T_world_estimate.yaw), -std::sin(T_world_estimate.yaw));
  draw_line(frame, robot - 5.0 * ahead, robot + 8.0 * ahead, 3.0, {kRobotColor, 1.0});
  draw_disc(frame, robot, 4.0, {kRobotColor, 1.0});
}

// Each known cell colours its pixel, walls on top: a wall of one cell stays visible however small the picture is.
void MapInset::lay_out(const Frame& frame, const RunSnapshot& snapshot) {
  constexpr double kMaxWidth = 0.30, kMaxHeight = 0.62;  // of the frame
  constexpr double kMargin_px = 16.0, kMargin_m = 1.0;
  map_ = snapshot.map;
  Eigen::AlignedBox2d shown = known_part(*map_, snapshot.T_world_map);
  picture_ = Frame();
  if (shown.isEmpty()) return;
  shown.min().array() -= kMargin_m;
  shown.max().array() += kMargin_m;
  low_m_ = shown.min();
  high_m_ = shown.max();
  const Eigen::Vector2d size_m = shown.sizes();
  px_per_m_ = std::min({kMaxWidth * frame.width() / size_m.x(), kMaxHeight * frame.height() / size_m.y(),
                        1.0 / map_->geometry().resolution_m});
  const int width = static_cast<int>(std::ceil(size_m.x() * px_per_m_));
  const int height = static_cast<int>(std::ceil(size_m.y() * px_per_m_));
  corner_px_ = {frame.width() - width - kMargin_px, frame.height() - height - kMargin_px};

  picture_ = Frame(width, height, kNothing);
  for (const bool is_wall_pass : {false, true}) {
    for (int row = 0; row < map_->geometry().height; ++row) {
      for (int col = 0; col < map_->geometry().width; ++col) {
        const std::int8_t value = map_->at({col, row});
        if (value == kUnknown || (value > 50) != is_wall_pass) continue;
        const Eigen::Vector2d p = pixel_of(snapshot.T_world_map * map_->geometry().center_of({col, row})) - corner_px_;
        const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
        if (picture_.contains(x, y)) picture_.at(x, y) = is_wall_pass ? kOccupiedCell : kFreeCell;
      }
    }
  }
}

void MapInset::draw_map(Frame& frame) const {
  const int left = static_cast<int>(corner_px_.x()), top = static_cast<int>(corner_px_.y());
  fill_rectangle(frame, left - 2, top - 2, picture_.width() + 4, picture_.height() + 4, {{235, 238, 242}, 0.8});
  for (int y = 0; y < picture_.height(); ++y) {
    for (int x = 0; x < picture_.width(); ++x) {
      if (frame.contains(left + x, top + y)) frame.at(left + x, top + y) = picture_.at(x, y);
    }
  }
}

Eigen::Vector2d MapInset::pixel_of(const Eigen::Vector2d& p_world_m) const {
  return corner_px_ + px_per_m_ * Eigen::Vector2d(p_world_m.x() - low_m_.x(), high_m_.y() - p_world_m.y());
}

}  // namespace patrol::render
