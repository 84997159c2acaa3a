#pragma once

#include <cstddef>
#include <vector>

#include "app/study/scan_world.h"

namespace patrol::app {

/// Settings of the rule that chooses the positions of the scanner.
struct ScannerChoiceSettings {
  double pose_spacing_m = 2.5;    ///< distance between the lidars on the roads
  double grid_m = 1.5;            ///< distance between the candidates
  double max_from_road_m = 1.5;   ///< largest distance of a candidate from a center line
  double free_m = 0.7;            ///< free distance around a candidate
  double edge_weight = 0.5;       ///< weight that a beam at an edge loses if the scanner's beams are kEdge_m apart
  double max_spacing_m = 0.8;     ///< largest distance of the scanner's beams on a surface that counts as seen
  float planar_weight = 0.7f;     ///< weight of the 2D lidar relative to that of the 3D lidar
  std::size_t num_restarts = 40;  ///< of the exchange, each without three positions
};

/// Rule of a surveyor with a model of the site: positions on the roads from which the scanner sees what lidars on the
/// roads see. Beams of a 2D and a 3D lidar from regular positions along the roads end on the surfaces of the empty
/// world. The value of a beam is 1 if a scanner sees its surface, less at edges, which distant scanners measure
/// coarsely. Positions are chosen greedily, then exchanged one by one, then chosen again without three of them, as long
/// as the sum of the values grows. Independent of the held-out poses and of the seeds of the study.
class ScannerChoice {
 public:
  ScannerChoice(const ScannedWorld& world, const ScannerChoiceSettings& settings);

  /// Returns `count` positions of the largest value that the search finds.
  std::vector<Eigen::Vector2d> choose(std::size_t count) const;
  /// Returns the mean value of the beams for scanners at positions, 0 ... 1.
  double value_of(const std::vector<Eigen::Vector2d>& scanners_m) const;

 private:
  using Values = std::vector<std::uint8_t>;  ///< [beam], up to kFullValue
  /// End of a beam.
  struct Target {
    Eigen::Vector3d p_m;
    float weight;
    bool is_edge;  ///< whether a beam 3 cm beside it ends elsewhere
  };

  void add_targets(const Eigen::Vector2d& p_m, double phase);
  void add_target(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_range_m, float weight);
  void add_candidates();
  Values values_at(const Eigen::Vector2d& p_m) const;
  Values best_of(const std::vector<std::size_t>& chosen, std::size_t without) const;
  double mean(const Values& values) const;
  std::size_t best_addition(const Values& values) const;
  bool exchange(std::vector<std::size_t>& chosen, int max_rounds) const;

  const ScannedWorld& world_;
  ScannerChoiceSettings settings_;
  RayWorld rays_;
  std::vector<Target> targets_;
  std::vector<Eigen::Vector2d> candidates_m_;
  std::vector<Values> values_;  ///< [candidate]
};

}  // namespace patrol::app
