#pragma once

#include <cmath>

#include "app/report/run_contents.h"

namespace patrol::test {

/// Ten seconds along x at 1 m/s, for whom the estimate, 10 cm to the left, is a map that starts at (5, 6) in world; met
/// its one expectation.
inline app::RunContents small_run() {
  app::RunContents run;
  run.directory = {"absent"};
  run.is_complete = true;
  run.name = "small";
  run.T_world_map = {5.0, 6.0, 0.0};
  for (int i = 0; i <= 100; ++i) {
    const Time stamp = std::chrono::milliseconds(100 * i);
    const double x_m = 0.1 * i;
    run.record.T_world_body.push_back({stamp, to_pose3({5.0 + x_m, 6.0, 0.0})});
    run.record.T_odom_body.push_back({stamp, to_pose3({1.05 * x_m, 0.0, 0.0})});
    run.record.T_map_body.push_back({stamp, to_pose3({x_m, 0.1, 0.0})});
    run.record.covariances.push_back(Eigen::Vector3d(0.0009, 0.0016, 0.0001).asDiagonal());
  }
  run.record.is_complete = true;
  const GridGeometry geometry{.resolution_m = 0.1, .width = 120, .height = 20, .origin_m = {-1.0, -1.0}};
  run.record.map = OccupancyGrid(geometry, kFree);
  for (int col = 0; col < 120; ++col) run.record.map.at({col, 19}) = kOccupied;
  run.scenario.expect = {{"pose.ate_rmse_m", {.max = 0.15}}};
  run.metrics = io::Metrics::parse(
      R"({"mission": {"completed": true, "collisions": 0, "distance_m": 10, "duration_s": 10}, "pose": {"ate_rmse_m": 0.1, "ate_max_m": 0.1}})");
  run.cases = {{.class_name = "small", .name = "run", .message = "", .details = ""}};
  return run;
}

}  // namespace patrol::test
