#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace patrol::app {

/// World with positions for panoramic scans, and with roads on which its site is compared.
struct ScannedWorld {
  std::string name;       ///< name of the world in worlds/
  std::string scenario;   ///< navigation in the world, below the data root
  double step_deg = 0.0;  ///< angular step of the scanner; the 12 scans together have about 19 million points
  double elevation_min_deg = -60.0;  ///< lowest elevation of the beams of the scanner
  std::vector<Eigen::Vector2d> scanners_m;
  std::vector<std::vector<Eigen::Vector2d>> roads_m;  ///< center lines
  double half_road_m = 1.5;                           ///< half the width of the roads
  std::size_t guest_scan = 0;                         ///< scan in which a person and a truck are present
  Eigen::Vector2d person_m, truck_m;
  double truck_yaw_deg = 0.0;
};

const std::vector<ScannedWorld>& scanned_worlds();

}  // namespace patrol::app
