#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/random.h"

namespace patrol::slam {

/// Position of a swarm member in problem-specific coordinates, at most four. In SLAM: whitened odometry increment since
/// the last pose, with zero at the odometry and unit variance per coordinate. The update rules of the sources multiply
/// positions and therefore depend on the origin. In map coordinates the result would depend on the start pose of the
/// robot.
using Position = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 4, 1>;

/// Log fitness of a position given the newest observation; larger is better. It may differ between members: in SLAM
/// each particle has its own map.
using Fitness = std::function<double(std::size_t member, const Position& position)>;

struct Swarm {
  std::vector<Position> positions;  ///< [member]
  std::vector<double> fitness;      ///< [member], fitness of its position

  std::size_t size() const { return positions.size(); }
  std::size_t best() const;
  /// Returns the member indices in descending order of fitness.
  std::vector<std::size_t> ranking() const;
  /// Moves the member to the candidate if the fitness increases (greedy acceptance); returns whether it did. Equal
  /// fitness is rejected: without observations all positions are equal, and arbitrary jumps would be accepted.
  bool accept(std::size_t member, const Position& candidate, const Fitness& fitness_of);
};

/// Evaluates the fitness of all positions.
Swarm make_swarm(std::vector<Position> positions, const Fitness& fitness_of);

/// Interface of a swarm optimizer. The fitness of no member decreases.
class SwarmOptimizer {
 public:
  virtual ~SwarmOptimizer() = default;

  virtual void move(Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const = 0;
};

}  // namespace patrol::slam
