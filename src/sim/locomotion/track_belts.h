#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/robot_description.h"

namespace patrol::sim {

/// The belts of a pair of tracks as contact sees them: the wheels that a belt runs round do not turn, but their surfaces move with it
/// (MuJoCo's geom/surfacevel). So slip, scrub and stall come from contact. What the ground does to a belt comes back to its
/// sprocket as torque, by virtual work: the contact's force times the surface's velocity per rad/s of the sprocket.
///
/// The torque is that of the last evaluation of the physics, one tick ago; the inertia that the sprocket sees through its gear
/// (robot_model.cc) keeps that stable. Not modelled: the belt's tension, and lugs.
class TrackBelts {
 public:
  /// Sets the friction of the belts' geoms in `physics`. Throws InputError when the model has not the robot's tracks.
  TrackBelts(const RobotDescription& robot, double friction, mjModel& physics);

  /// Moves the belts' surfaces as the sprockets will turn at the end of this tick.
  void run(mjModel& physics, const mjData& data) const;

  /// What the ground does to each sprocket, left and right, N m.
  std::array<double, 2> drag_nm(const mjModel& physics, const mjData& data) const;

  /// Degree of freedom of each sprocket, left and right.
  const std::array<int, 2>& sprocket_dofs() const { return sprocket_dofs_; }

 private:
  struct Wheel {
    int geom;
    std::size_t side;                 ///< 0 left, 1 right
    Eigen::Vector3d rate_per_radps;   ///< of its surface, per rad/s of the sprocket, in the geom's frame
  };

  std::vector<Wheel> wheels_;
  std::vector<int> wheel_of_geom_;  ///< index in wheels_; -1 for other geoms
  std::array<int, 2> sprocket_dofs_{};
};

}  // namespace patrol::sim
