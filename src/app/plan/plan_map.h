#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/grid.h"
#include "io/maps/moving_ai.h"

namespace patrol::app {

/// Map of `patrol plan` with the coordinates of its users: meters in its frame on a map_server map; cells from the
/// upper left, y down, on a MovingAI map, as in .scen files. Internally both are meters in the grid's frame, y up, with
/// MovingAI cells of 1 m.
class PlanMap {
 public:
  /// Loads a map. Throws InputError with the file and the line.
  explicit PlanMap(const std::filesystem::path& file);

  bool is_moving_ai() const { return moving_ai_.has_value(); }
  const char* unit() const { return is_moving_ai() ? "cells" : "m"; }
  const GridGeometry& geometry() const {
    return is_moving_ai() ? moving_ai_->terrain.geometry() : occupancy_.geometry();
  }
  /// Occupancy for a robot at a position; on a MovingAI map it depends on whether the position is in water or on land.
  OccupancyGrid occupancy_from(const Eigen::Vector2d& p_m) const;

  /// Converts a point from the user's coordinates. `key` names the point in messages. Throws InputError if the point is
  /// invalid or outside the map.
  Eigen::Vector2d parse_point(const std::string& key, const std::string& text) const;
  Eigen::Vector2d parse_point(const std::string& key, double x, double y) const;
  /// Converts a position to the user's coordinates.
  Eigen::Vector2d to_user(const Eigen::Vector2d& p_m) const;
  std::string text_of(const Eigen::Vector2d& p_m) const;

 private:
  std::string extent() const;

  std::optional<io::MovingAiMap> moving_ai_;
  OccupancyGrid occupancy_;  ///< grid of a map_server map
};

}  // namespace patrol::app
