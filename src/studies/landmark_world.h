#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "studies/landmarks/control_motion.h"
#include "studies/landmarks/range_bearing.h"

namespace patrol::studies {

/// Flat world of point landmarks with a trajectory, for the simulations of the publications. The robot follows the
/// trajectory exactly; its odometry and its observations are noisy.
struct LandmarkWorld {
  std::string name;
  ControlMotion motion;                                     ///< `std`: noise of the odometry
  Eigen::Vector2d odometry_bias = Eigen::Vector2d::Zero();  ///< odometry bias, unknown to the filters
  RangeBearingNoise noise;
  double max_range_m = 10.0;
  double field_of_view_rad = 6.3;            ///< centered straight ahead
  std::vector<Eigen::Vector2d> landmarks_m;  ///< in map: the robot starts at its origin, along x
  std::vector<Control> controls;             ///< [part of a step], ground truth
};

/// Measurements of one run with the ground truth.
struct LandmarkRun {
  std::vector<Control> odometry;                        ///< [step]
  std::vector<std::vector<RangeBearing>> observations;  ///< [step][observation]
  std::vector<Pose2> truth;                             ///< [step], after its motion
};

LandmarkRun simulate(const LandmarkWorld& world, std::uint64_t seed);

/// World of 20 m x 20 m [Wu25]. The publication states neither layout nor odometry errors. Here: one lap of a circle of
/// radius 7 m, or of r = 7 (0.886 + 0.257 cos 3s + 0.086 sin 2s) m. 24 landmarks lie alternately 2 m inside and outside
/// of the trajectory. They are observed in all directions up to 10 m, every 0.1 s, with 0.5 m and 5 degrees.
///
///   "M"   odometry noise 0.2 m/s and 10 deg/s, as assumed by the filters
///   "S5"  0.1 m/s and 5 deg/s, and a bias of 2 deg/s that is unknown to the filters
///   "S3"  0.1 m/s and 3 deg/s, and the bias of "S5"
LandmarkWorld garden_world(const std::string& odometry, bool is_circle);

/// World of 100 m x 80 m [Cui21]. A car of 2 m wheelbase drives clockwise from the middle past 15 waypoints among 31
/// landmarks, with steering limits of 30 degrees and 20 deg/s, in steps of 0.025 s. Noise: ranges 0.3 m, speed 0.5 m/s,
/// steering 5 degrees.
///
/// Not stated and chosen here: the layout; bearing noise of 1 degree; landmarks are observed in the front half up to 30
/// m at every eighth step (defaults of Bailey's FastSLAM simulator). Odometry between two observations is one step of
/// eight parts, whose controls are the mean of the measurements. `is_biased`: the odometry is biased by 0.3 m/s and 2
/// degrees, unknown to the filters.
LandmarkWorld campus_world(bool is_biased, double speed_mps, int num_steps);

}  // namespace patrol::studies
