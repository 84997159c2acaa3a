#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

#include "core/random.h"

namespace patrol::slam {

/// Where a member of a swarm stands, in coordinates that the problem chooses, at most four. For SLAM they are the whitened increment of
/// odometry since the last pose: zero is what odometry said, and each has unit variance. The moves of the papers multiply positions, so
/// that they depend on where the origin is; in map coordinates that would be where the robot happened to start.
using Position = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 4, 1>;

/// Logarithm of how well a position explains the newest observation, the greater the better. Members may judge the same position
/// differently: in SLAM each particle has a map of its own.
using Fitness = std::function<double(std::size_t member, const Position& position)>;

struct Swarm {
  std::vector<Position> positions;  ///< [member]
  std::vector<double> fitness;      ///< [member], of its position

  std::size_t size() const { return positions.size(); }
  std::size_t best() const;
  /// Members from the best to the worst.
  std::vector<std::size_t> ranking() const;
  /// Moves the member there if that is better for it (greedy acceptance). Whether it did. What nothing speaks for is not taken: where there is nothing
  /// to see yet, all positions are alike, and the longest jump would be as good as any.
  bool accept(std::size_t member, const Position& candidate, const Fitness& judge);
};

/// Positions with their fitness.
Swarm make_swarm(std::vector<Position> positions, const Fitness& judge);

/// Moves a swarm towards better fitness. No member ends worse than it began.
class SwarmOptimizer {
 public:
  virtual ~SwarmOptimizer() = default;

  virtual void move(Swarm& swarm, const Fitness& judge, RandomSequence& random) const = 0;
};

}  // namespace patrol::slam
