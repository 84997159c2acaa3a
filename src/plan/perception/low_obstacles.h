#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/grid.h"
#include "core/settings.h"
#include "core/time.h"
#include "plan/perception/low_obstacles_settings.h"

namespace patrol::plan {

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

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(cells_, changed_, num_obstacles_);
  }

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
