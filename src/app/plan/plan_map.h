#pragma once

#include <Eigen/Core>

#include <filesystem>
#include <optional>
#include <string>

#include "core/grid.h"
#include "io/moving_ai.h"

namespace patrol::app {

/// Anybody's map, and what its places are called: metres in its frame on a map_server map; on a MovingAI map cells from the upper left, y down, as .scen
/// files have them. In the program both are metres in the grid's frame, y up, a MovingAI cell being 1 m.
class PlanMap {
 public:
  /// Throws InputError with the file and the line.
  explicit PlanMap(const std::filesystem::path& file);

  bool is_moving_ai() const { return moving_ai_.has_value(); }
  const char* unit() const { return is_moving_ai() ? "cells" : "m"; }
  const GridGeometry& geometry() const { return is_moving_ai() ? moving_ai_->terrain.geometry() : occupancy_.geometry(); }
  /// For one who stands there: on a MovingAI map in water or on land.
  OccupancyGrid occupancy_from(const Eigen::Vector2d& p_m) const;

  /// `key` names the point in messages. Throw InputError when it is none, or lies outside the map.
  Eigen::Vector2d place(const std::string& key, const std::string& text) const;
  Eigen::Vector2d place(const std::string& key, double x, double y) const;
  /// As a person names the place.
  Eigen::Vector2d named(const Eigen::Vector2d& p_m) const;
  std::string text_of(const Eigen::Vector2d& p_m) const;

 private:
  std::string extent() const;

  std::optional<io::MovingAiMap> moving_ai_;
  OccupancyGrid occupancy_;  ///< of a map_server map
};

}  // namespace patrol::app
