#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/grid.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol::plan {

struct LowObstaclesSettings {
  double persistence_s = 60.0;        ///< persistence of an obstacle out of view: under the bow, next to a track
  double dynamic_persistence_s = 3.0;  ///< persistence next to a lidar obstacle, which may be a pedestrian's legs
  double sonar_persistence_s = 15.0;  ///< persistence of an obstacle detected by sonar only
  double camera_clearing_s = 2.0;    ///< age up to which ground in an image overrules sonar echoes
  int min_camera_points = 2;     ///< points of one image in one cell
  int confirmations = 2;         ///< images or pings that make an obstacle

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("persistence_s", self.persistence_s, between(0.1, 3600.0));
    visit("dynamic_persistence_s", self.dynamic_persistence_s, between(0.1, 3600.0));
    visit("sonar_persistence_s", self.sonar_persistence_s, between(0.1, 3600.0));
    visit("camera_clearing_s", self.camera_clearing_s, between(0.0, 60.0));
    visit("min_camera_points", self.min_camera_points, between(1, 100));
    visit("confirmations", self.confirmations, between(1, 20));
  }
};

/// Obstacles below the lidar's plane, by cells of a lattice, accumulated from images and pings. Each source increments
/// its own count of a cell for an obstacle and decrements it for free ground. A count of `confirmations` makes an
/// obstacle, which stays until its count is used up or its persistence ends. Sonar does not clear obstacles of the
/// camera, because it detects a thin bar only occasionally. The camera clears obstacles of sonar, because an arc is
/// wider than its object.
class LowObstacles {
 public:
  explicit LowObstacles(const LowObstaclesSettings& settings) : settings_(settings) {}

  /// Adds the cells of an image that show an obstacle and those that show ground, without repetition. `may_move`
  /// [obstacle]: the lidar also has an obstacle there.
  void add_image(const std::vector<Cell>& obstacles, const std::vector<Cell>& ground, const std::vector<bool>& may_move,
                 Time now);
  /// Adds the cells of a ping's arc and of the free ground before it, without repetition.
  void add_ping(const std::vector<Cell>& arc, const std::vector<Cell>& free, Time now);
  /// Clears the sonar evidence of the cells for which the predicate is true.
  template <typename Predicate>
  void clear_sonar_evidence(const Predicate& is_in_area) {
    for (auto& [key, evidence] : cells_) {
      if (!is_in_area(to_cell(key))) continue;
      evidence.sonar = 0;
      update_obstacle(key, evidence);
    }
  }
  /// Clears evidence whose persistence has ended.
  void clear_expired(Time now);

  bool is_obstacle(Cell cell) const;
  std::size_t num_obstacles() const { return num_obstacles_; }
  /// Returns the cells that have become obstacles, or are no longer obstacles, since the last call; possibly repeated.
  std::vector<Cell> take_changed() { return std::exchange(changed_, {}); }
  /// All obstacles, row by row.
  std::vector<Cell> obstacles() const;

 private:
  using Key = std::pair<int, int>;  ///< row, column
  struct Evidence {
    int camera = 0;
    int sonar = 0;
    Time camera_until{};  ///< end of the persistence of the camera's evidence
    Time sonar_until{};
    Time ground_observed = Time::min();
    bool is_obstacle = false;
  };

  static Cell to_cell(const Key& key) { return {key.second, key.first}; }
  static Key to_key(Cell cell) { return {cell.row, cell.col}; }
  bool is_cleared_by_camera(const Evidence& evidence, Time now) const;
  void update_obstacle(const Key& key, Evidence& evidence);

  LowObstaclesSettings settings_;
  std::map<Key, Evidence> cells_;
  std::vector<Cell> changed_;
  std::size_t num_obstacles_ = 0;
};

}  // namespace patrol::plan
