#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/messages.h"
#include "core/random.h"

namespace patrol::test {

/// A wall, from a to b, in world, m.
struct Segment {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
};

/// A flat world of line segments, seen by an ideal lidar: ranges are exact until noise is asked for.
class RoomWorld {
 public:
  RoomWorld& add_wall(double ax, double ay, double bx, double by) {
    walls_.push_back({{ax, ay}, {bx, by}});
    return *this;
  }
  /// Joins the points one after the other.
  RoomWorld& add_polyline(const std::vector<Eigen::Vector2d>& points) {
    for (std::size_t i = 1; i < points.size(); ++i) walls_.push_back({points[i - 1], points[i]});
    return *this;
  }
  RoomWorld& add_box(double x_min, double y_min, double x_max, double y_max) {
    return add_polyline({{x_min, y_min}, {x_max, y_min}, {x_max, y_max}, {x_min, y_max}, {x_min, y_min}});
  }
  /// A regular polygon about a circle: posts, trees, legs.
  RoomWorld& add_post(double x, double y, double radius, int corners = 12) {
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i <= corners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / corners;
      points.emplace_back(x + radius * std::cos(angle), y + radius * std::sin(angle));
    }
    return add_polyline(points);
  }
  RoomWorld& add(const RoomWorld& other) {
    walls_.insert(walls_.end(), other.walls_.begin(), other.walls_.end());
    return *this;
  }

  const std::vector<Segment>& walls() const { return walls_; }

  /// Distance from p to the nearest wall, m.
  double distance_m(const Eigen::Vector2d& p) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Segment& wall : walls_) {
      const Eigen::Vector2d along = wall.b - wall.a;
      const double fraction = std::clamp((p - wall.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (p - wall.a - fraction * along).norm());
    }
    return nearest;
  }

  /// [beam], +inf beyond `range_max_m`. Beam i looks to yaw + 2 pi i / beams. Each wall only meets the beams in the
  /// angle that it fills, so a street of a thousand walls is quick.
  std::vector<double> ranges_m(const Pose2& T_world_body, int beams, double range_max_m) const {
    std::vector<double> ranges(static_cast<std::size_t>(beams), std::numeric_limits<double>::infinity());
    const Pose2 T_body_world = T_world_body.inverse();
    const double increment = 2.0 * std::numbers::pi / beams;
    for (const Segment& wall : walls_) {
      const Eigen::Vector2d a = T_body_world * wall.a, b = T_body_world * wall.b;
      const double cross = a.x() * b.y() - a.y() * b.x();
      if (cross == 0.0) continue;  // seen end on
      const double span = std::atan2(std::abs(cross), a.dot(b));
      const Eigen::Vector2d& right = cross > 0.0 ? a : b;
      const double first = std::atan2(right.y(), right.x());
      const int begin = static_cast<int>(std::ceil(first / increment));
      const int end = static_cast<int>(std::floor((first + span) / increment));
      const Eigen::Vector2d along = b - a;
      for (int i = begin; i <= end; ++i) {
        const double angle = i * increment;
        // Ray s (cos, sin) meets a + u along: s = a x along / (direction x along).
        const double range = cross / (std::cos(angle) * along.y() - std::sin(angle) * along.x());
        const auto beam = static_cast<std::size_t>((i % beams + beams) % beams);
        if (range > 0.0 && range <= range_max_m) ranges[beam] = std::min(ranges[beam], range);
      }
    }
    return ranges;
  }

  struct ScanOptions {
    int beams = 1600;
    double range_max_m = 30.0;
    double no_return_clearing_range_m = 6.0;  ///< range up to which a beam without return is taken to be free
    double range_std_m = 0.0;
  };

  /// A level scan from T_world_body with the lidar at the body's origin. `noise` and `tick` say which noise.
  LevelScan scan(const Pose2& T_world_body, Time stamp, const ScanOptions& options, const RandomStream& noise,
                 std::uint64_t tick) const {
    const std::vector<double> ranges = ranges_m(T_world_body, options.beams, options.range_max_m);
    LevelScan scan;
    scan.stamp = stamp;
    for (std::size_t beam = 0; beam < ranges.size(); ++beam) {
      const bool is_hit = std::isfinite(ranges[beam]);
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(beam) / options.beams;
      double range = is_hit ? ranges[beam] : options.no_return_clearing_range_m;
      if (is_hit && options.range_std_m > 0.0) range += options.range_std_m * noise.normal(tick, beam);
      scan.beams.push_back({(range * Eigen::Vector2d(std::cos(angle), std::sin(angle))).cast<float>(), is_hit});
    }
    return scan;
  }
  /// Scan without noise.
  LevelScan scan(const Pose2& T_world_body, const ScanOptions& options) const {
    return scan(T_world_body, Time{}, options, RandomStream(0, "no noise"), 0);
  }

 private:
  std::vector<Segment> walls_;
};

}  // namespace patrol::test
