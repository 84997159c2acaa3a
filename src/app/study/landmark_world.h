#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

#include "slam/landmarks/control_motion.h"
#include "slam/landmarks/range_bearing.h"

namespace patrol::app {

/// A flat world of point landmarks and a way through it, for the papers' simulations. The robot follows the way exactly; its odometry and
/// its sights are wrong.
struct LandmarkWorld {
  std::string name;
  slam::ControlMotion motion;                    ///< `std`: of the odometry's noise
  Eigen::Vector2d odometry_bias = Eigen::Vector2d::Zero();  ///< what odometry says too much of each control; known to nobody
  slam::RangeBearingNoise noise;
  double max_range_m = 10.0;
  double field_of_view_rad = 6.3;                ///< about straight ahead
  std::vector<Eigen::Vector2d> landmarks_m;      ///< in map: the robot starts at its origin, along x
  std::vector<slam::Control> controls;           ///< [step's part], true
};

/// What one run gives the robot, and the truth beside it.
struct LandmarkRun {
  std::vector<slam::Control> odometry;                  ///< [step]
  std::vector<std::vector<slam::RangeBearing>> seen;    ///< [step][sight]
  std::vector<Pose2> truth;                             ///< [step], after its motion
};

LandmarkRun simulate(const LandmarkWorld& world, std::uint64_t seed);

/// Paper 000's 20 m x 20 m worlds. It states neither layout nor odometry's errors; here: one lap of a circle of radius 7 m (or of
/// r = 7 (0.886 + 0.257 cos 3s + 0.086 sin 2s) m), 24 landmarks in turn 2 m inside and outside of the way, seen all round up to 10 m every 0.1 s,
/// 0.5 m and 5 degrees.
///
///   "M"   odometry's noise 0.2 m/s and 10 deg/s, as the filters believe
///   "S5"  0.1 m/s and 5 deg/s, and a bias of 2 deg/s that no filter is told of
///   "S3"  0.1 m/s and 3 deg/s, and the same bias
LandmarkWorld garden_world(const std::string& odometry, bool is_circle);

/// Paper 001's 100 m x 80 m: a car of 2 m wheelbase drives clockwise from the middle round 15 waypoints among 31 landmarks, with 30 degrees and 20 deg/s of
/// steering at most, in steps of 0.025 s. Ranges err by 0.3 m, speed by 0.5 m/s, steering by 5 degrees. What the paper leaves open: layout; bearings err by
/// 1 degree, landmarks are seen in the front half up to 30 m at every eighth step (defaults of Bailey's FastSLAM simulator). Odometry between two sights is
/// one step of eight parts, whose controls are the mean of what was measured. `is_biased`: odometry says 0.3 m/s and 2 degrees too much, which no filter
/// is told.
LandmarkWorld campus_world(bool is_biased, double speed_mps, int num_steps);

}  // namespace patrol::app
