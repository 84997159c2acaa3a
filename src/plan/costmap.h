#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/distance_transform.h"
#include "core/frames.h"
#include "core/grid.h"
#include "core/messages.h"
#include "core/settings.h"
#include "plan/depth_points.h"
#include "plan/footprint.h"
#include "plan/low_obstacles.h"
#include "plan/sonar_cone.h"

namespace patrol::plan {

struct CostmapSettings {
  double resolution_m = 0.1;
  double inflation_radius_m = 1.0;      ///< obstacles nearer than this to the body's centre cost something
  double inflation_decay_m = 0.25;      ///< over this distance the cost falls to 1/e
  double safety_margin_m = 0.05;        ///< kept from the robot's outline
  double route_margin_m = 0.0;          ///< kept by routes beyond that: the discs stick out, and a robot must be steered
  double unknown_cost = 0.15;           ///< of a cell nobody has seen, as a fraction of the highest passable cost
  bool crosses_unknown = true;          ///< false: what the map does not know is no way; for a robot whose map is complete
  int occupied_percent = 65;            ///< map cells from here on are obstacles
  double obstacle_range_m = 8.0;        ///< live hits nearer than this are obstacles before the map knows them
  double obstacle_memory_s = 8.0;       ///< how long a live obstacle is believed without being seen again
  int map_slack_cells = 0;              ///< a hit this near to an obstacle of the map is that: noise makes no wall thicker
  double keep_out_margin_m = 0.2;       ///< between a keep-out line and the axis of the body
  double keep_out_inflation_m = 0.25;   ///< beyond the margin, where nearness to a line costs something
  LowObstaclesSettings low = {};

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("resolution_m", self.resolution_m, between(0.02, 0.5));
    visit("inflation_radius_m", self.inflation_radius_m, between(0.05, 3.0));
    visit("inflation_decay_m", self.inflation_decay_m, between(0.01, 3.0));
    visit("safety_margin_m", self.safety_margin_m, between(0.0, 0.5));
    visit("route_margin_m", self.route_margin_m, between(0.0, 0.5));
    visit("unknown_cost", self.unknown_cost, between(0.0, 1.0));
    visit("crosses_unknown", self.crosses_unknown);
    visit("occupied_percent", self.occupied_percent, between(1, 100));
    visit("obstacle_range_m", self.obstacle_range_m, between(1.0, 30.0));
    visit("obstacle_memory_s", self.obstacle_memory_s, between(0.1, 600.0));
    visit("map_slack_cells", self.map_slack_cells, between(0, 5));
    visit("keep_out_margin_m", self.keep_out_margin_m, between(0.0, 1.0));
    visit("keep_out_inflation_m", self.keep_out_inflation_m, between(0.0, 2.0));
    visit("low", self.low);
  }
};

using Polyline = std::vector<Eigen::Vector2d>;
using Cost = std::uint8_t;
inline constexpr Cost kFreeCost = 0;
inline constexpr Cost kMaxPassableCost = 252;
inline constexpr Cost kLethalCost = 255;

/// Where the body may go, and how gladly, in `map`. Four layers:
///
///   map       SLAM's occupancy grid, max-pooled to the costmap's cells;
///   live      what the lidar hits now and the map does not (yet) have. A hit vanishes when a later beam passes beyond it:
///             people move on, and leave nothing behind;
///   low       what stands below the lidar's plane, from the depth camera and the ultrasonic ring (plan/low_obstacles.h);
///   keep-out  surveyed lines that the lidar cannot see (full-height kerbs).
///
/// Obstacles are inflated by their exact distance: lethal where the robot's inscribed circle would touch, then falling
/// exponentially. A change refreshes only its own surroundings. Cells lie on multiples of the resolution, so that the
/// costmap can grow without moving.
class Costmap {
 public:
  Costmap(const CostmapSettings& settings, const Footprint& footprint, std::vector<Polyline> keep_out_lines_in_map);

  /// Throws InputError if the map's cells are larger than the costmap's.
  void set_map(const OccupancyGrid& map);
  void add_scan(const LevelScan& scan, const Pose2& T_map_body);
  /// What a depth image shows, and what a ping says of the ground; in level, when the body was there.
  void add_image(const DepthPoints& points, Time stamp, const Pose2& T_map_body);
  void add_ping(const SonarCone& cone, Time stamp, const Pose2& T_map_body);
  /// Forgets the live obstacles around a place, and what only sonar has heard; what is really there will be seen again.
  void forget_live(const Eigen::Vector2d& p_map, double radius_m);
  /// Grows, if needed, so that `margin_m` around the point lies inside.
  void include(const Eigen::Vector2d& p_map, double margin_m);

  const CostmapSettings& settings() const { return settings_; }
  const Footprint& footprint() const { return footprint_; }
  const GridGeometry& geometry() const { return cost_.geometry(); }
  const Grid<Cost>& cost() const { return cost_; }
  /// Outside the grid nothing is known.
  Cost cost_at(const Eigen::Vector2d& p_map) const;
  bool is_live_obstacle(Cell cell) const { return live_.contains(cell) && live_.at(cell) != 0; }
  /// Since when the longest-standing of the live obstacles about a place is known; none if there are none.
  std::optional<Time> live_since(const Eigen::Vector2d& p_map, double radius_m) const;
  std::size_t num_live_obstacles() const { return live_cells_.size(); }
  bool is_low_obstacle(Cell cell) const { return is_low_.contains(cell) && is_low_.at(cell) != 0; }
  std::size_t num_low_obstacles() const { return low_.num_obstacles(); }

  /// To the nearest obstacle's surface, interpolated between cells; at most `max_distance_m`.
  double obstacle_distance_m(const Eigen::Vector2d& p_map) const;
  /// To the nearest keep-out line, interpolated likewise; at most margin + `max_distance_m`.
  double keep_out_distance_m(const Eigen::Vector2d& p_map) const;
  /// Free room around the robot's outline; negative if something or a keep-out line lies too near.
  double clearance_m(const Pose2& T_map_body) const;
  double max_distance_m() const { return distance_of_.back(); }

 private:
  /// Cells from `min` up to and including `max`; empty at first.
  struct CellBox {
    Cell min{1, 1};
    Cell max{0, 0};
    bool is_empty() const { return max.col < min.col; }
    void extend(Cell cell);
    CellBox grown(int cells, const GridGeometry& within) const;
  };
  struct LiveObstacle {
    Cell lattice;  ///< cell counted from the map's origin, so that growing keeps it
    Time seen{};
    Time first_seen{};
  };

  void allocate(Cell min, Cell max);
  Cell to_cell(const LiveObstacle& obstacle) const { return to_grid(obstacle.lattice); }
  void lay_keep_out_lines();
  void drop_live(const LevelScan& scan, const Pose2& T_map_body, CellBox& changed);
  void mark_hits(const LevelScan& scan, const Pose2& T_map_body, CellBox& changed);
  /// The cells of these places that hold at least `min_count` of them; inside the grid, on the lattice.
  std::vector<Cell> lattice_cells(const std::vector<Eigen::Vector2d>& p_level, const Pose2& T_map_body, int min_count) const;
  Cell to_grid(Cell lattice) const { return {lattice.col - lattice_origin_.col, lattice.row - lattice_origin_.row}; }
  bool has_live_obstacle(Cell cell, int reach) const;  ///< within so many cells
  bool is_in_map(Cell cell, int reach) const;          ///< an obstacle, likewise
  void apply_low_changes(CellBox& changed);
  bool is_occupied(Cell cell) const;
  void refresh(const CellBox& changed);
  Cost unknown_cost() const;
  void price(Cell first, int count);

  CostmapSettings settings_;
  Footprint footprint_;
  std::vector<Polyline> keep_out_lines_;
  DistanceTransform transform_;
  std::vector<double> distance_of_;        ///< [squared cells], m, to the obstacle's surface
  std::vector<Cost> obstacle_cost_of_;     ///< [squared cells]

  Cell lattice_origin_;                    ///< cell (0, 0), counted from the map's origin
  OccupancyGrid map_;                      ///< max-pooled
  Grid<std::uint32_t> live_;               ///< 1 + index in live_cells_, 0 where there is none
  std::vector<LiveObstacle> live_cells_;
  LowObstacles low_;                       ///< on the lattice
  Grid<std::uint8_t> is_low_;              ///< the same, for quick looking up
  Grid<float> keep_out_distance_m_;
  Grid<std::int16_t> squared_;             ///< squared distance to the nearest obstacle, cells
  Grid<Cost> cost_;

  std::vector<std::uint8_t> window_obstacles_;
  DistanceTransform::SquaredDistances window_squared_;
};

}  // namespace patrol::plan
