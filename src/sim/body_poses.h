#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

namespace patrol::sim {

/// Poses of all bodies at an instant, in world.
class BodyPoses {
 public:
  using Rotation = Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>;

  BodyPoses() = default;
  BodyPoses(const mjModel& model, const mjData& data)
      : positions_(data.xpos, data.xpos + 3 * model.nbody), rotations_(data.xmat, data.xmat + 9 * model.nbody) {}

  Eigen::Map<const Eigen::Vector3d> position(int body) const {
    return Eigen::Map<const Eigen::Vector3d>(positions_.data() + 3 * static_cast<std::ptrdiff_t>(body));
  }
  Eigen::Map<const Rotation> rotation(int body) const {
    return Eigen::Map<const Rotation>(rotations_.data() + 9 * static_cast<std::ptrdiff_t>(body));
  }

 private:
  std::vector<mjtNum> positions_, rotations_;
};

}  // namespace patrol::sim
