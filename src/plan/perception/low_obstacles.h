#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/grid.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol::plan {

struct LowObstaclesSettings {
  double memory_s = 60.0;        ///< how long it is believed out of sight: under the nose, beside a track
  double moving_memory_s = 3.0;  ///< likewise where the lidar sees something too, a person's legs: that may walk on
  double sonar_memory_s = 15.0;  ///< of what only sonar has heard
  double camera_veto_s = 2.0;    ///< ground that the camera saw so lately is believed against sonar
  int min_camera_points = 2;     ///< of one image in one cell
  int confirmations = 2;         ///< images, or pings, until an obstacle is believed

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("memory_s", self.memory_s, between(0.1, 3600.0));
    visit("moving_memory_s", self.moving_memory_s, between(0.1, 3600.0));
    visit("sonar_memory_s", self.sonar_memory_s, between(0.1, 3600.0));
    visit("camera_veto_s", self.camera_veto_s, between(0.0, 60.0));
    visit("min_camera_points", self.min_camera_points, between(1, 100));
    visit("confirmations", self.confirmations, between(1, 20));
  }
};

/// What stands below the lidar's plane, by cells of a lattice, from evidence that is weak one by one: images and pings. Each
/// source adds to its own count where it finds something and takes off where it finds nothing; a count that has reached
/// `confirmations` makes an obstacle, which stays until it is taken off or its memory is over. Sonar does not undo what the camera
/// saw: it hears a thin bar only now and then. The camera does undo what sonar heard: an arc is wider than the thing.
class LowObstacles {
 public:
  explicit LowObstacles(const LowObstaclesSettings& settings) : settings_(settings) {}

  /// Cells in which an image shows an obstacle, and those in which it shows ground; without repetition. `may_move`: the lidar
  /// sees something there as well.
  void add_image(const std::vector<Cell>& obstacles, const std::vector<Cell>& ground, const std::vector<bool>& may_move,
                 Time now);
  /// Cells of a ping's arc and of the free ground before it; without repetition.
  void add_ping(const std::vector<Cell>& arc, const std::vector<Cell>& free, Time now);
  /// Forgets what only sonar has heard, where the predicate holds.
  template <typename Predicate>
  void forget_sonar(const Predicate& is_there) {
    for (auto& [key, evidence] : cells_) {
      if (!is_there(to_cell(key))) continue;
      evidence.sonar = 0;
      judge(key, evidence);
    }
  }
  /// Drops what has outlived its memory.
  void forget_old(Time now);

  bool is_obstacle(Cell cell) const;
  std::size_t num_obstacles() const { return num_obstacles_; }
  /// Cells that have become obstacles, or ceased to be, since the last call; maybe with repetition.
  std::vector<Cell> take_changed() { return std::exchange(changed_, {}); }
  /// All obstacles, row by row.
  std::vector<Cell> obstacles() const;

 private:
  using Key = std::pair<int, int>;  ///< row, column
  struct Evidence {
    int camera = 0;
    int sonar = 0;
    Time camera_until{};  ///< end of its memory
    Time sonar_until{};
    Time ground_seen = Time::min();
    bool is_obstacle = false;
  };

  static Cell to_cell(const Key& key) { return {key.second, key.first}; }
  static Key to_key(Cell cell) { return {cell.row, cell.col}; }
  bool is_vetoed(const Evidence& evidence, Time now) const;
  void judge(const Key& key, Evidence& evidence);

  LowObstaclesSettings settings_;
  std::map<Key, Evidence> cells_;
  std::vector<Cell> changed_;
  std::size_t num_obstacles_ = 0;
};

}  // namespace patrol::plan
