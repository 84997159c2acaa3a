#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "core/robot_description.h"
#include "sim/as_built/sensor_errors.h"

namespace patrol::sim {

/// Track contact model. The wheels of a track do not rotate; their surfaces move with the track (MuJoCo's
/// geom/surfacevel), so slip, scrub and stall result from contact.
///
/// The ground acts on a sprocket by virtual work: contact force times surface velocity per rad/s of the sprocket. The
/// torque is that of the last physics evaluation, one tick old; the inertia that the sprocket sees through its gear
/// (robot_model.cc) keeps this stable. Not modeled: track tension and lugs.
class TrackContact {
 public:
  /// Sets the friction of the track geoms in `physics`. Throws InputError when the model lacks the robot's tracks.
  TrackContact(const RobotDescription& robot, double friction, mjModel& physics, const TrackErrors& errors = {});

  /// Sets the surface velocities to the sprocket speeds at the end of this tick.
  void run(mjModel& physics, const mjData& data) const;

  /// Returns the torque of the ground on each sprocket, left and right, N m.
  std::array<double, 2> contact_torque_nm(const mjModel& physics, const mjData& data) const;

  /// Returns the degree of freedom of each sprocket, left and right.
  const std::array<int, 2>& sprocket_dofs() const { return sprocket_dofs_; }

 private:
  struct Wheel {
    int geom;
    std::size_t side;                ///< 0 left, 1 right
    Eigen::Vector3d rate_per_radps;  ///< angular velocity of the surface per rad/s of the sprocket, in the geom's
                                     ///< frame
  };

  std::vector<Wheel> wheels_;
  std::vector<int> wheel_of_geom_;  ///< index in wheels_; -1 for other geoms
  std::array<int, 2> sprocket_dofs_{};
};

}  // namespace patrol::sim
