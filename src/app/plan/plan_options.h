#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/common/print_result.h"

namespace patrol::app {

/// Options of `patrol plan`. Points are "X,Y": meters in a map_server map's frame, or cells from the upper left, y
/// down, on a MovingAI map.
struct PlanOptions {
  std::filesystem::path map = {};  ///< map_server YAML, MovingAI .map, or a .scen file of problems
  std::optional<std::string> from = {}, to = {};
  std::optional<std::filesystem::path> stations = {};  ///< stations to order (io/files/tour_stations.h)
  std::optional<std::string> planner = {};
  std::optional<std::string> robot = {};
  std::optional<double> radius_m = {};
  bool smooth = false;
  std::optional<double> speed_mps = {};
  std::optional<std::uint64_t> seed = {};
  std::vector<std::string> overrides = {};
  std::optional<std::filesystem::path> out = {};
  ResultForm form = ResultForm::kText;
};

}  // namespace patrol::app
