#pragma once

#include <cstdint>
#include <string>

#include "core/grid.h"
#include "importer/site/imported_site.h"

namespace patrol::importer {

/// Settings of an obstacle course. The default lengths are those of the Benchmark for Autonomous Robot Navigation
/// [Perille20] times `scale`, which fits them to a robot of another size than the one of the benchmark.
struct CourseSettings {
  double scale = 1.0;             ///< ratio of the robot's size to that of the benchmark's robot
  double radius_m = 0.075;        ///< radius of the cylinders; a cell is twice as wide
  int cells = 30;                 ///< cells of the field along each side
  double run_in_m = 2.0;          ///< distance from the start to the field
  double run_out_m = 3.5;         ///< distance from the field to the goal
  double passage_radius_m = 0.3;  ///< radius of the disk for which a path through the field exists
  double max_speed_mps = 2.0;     ///< speed of the optimal time
};

/// Obstacle course: a field of cylinders between a start at the origin, heading along x, and a goal on x behind it,
/// with walls at both sides.
struct Course {
  Grid<std::uint8_t> field;  ///< 1 for a cylinder; in site
  Eigen::Vector2d goal_m = Eigen::Vector2d::Zero();
  double path_length_m = 0.0;   ///< length of the shortest path of the disk from start to goal
  double optimal_time_s = 0.0;  ///< `path_length_m` at the maximum speed
  double fill = 0.0;            ///< probability of a cylinder before smoothing
  int smoothing_steps = 0;      ///< steps of the cellular automaton
};

/// Draws a course: cells are filled with a probability of 0.15, 0.2, 0.25 or 0.3, then smoothed by 2, 3 or 4 steps of a
/// cellular automaton, in which a cell becomes filled with five or more filled neighbors and empty with one or none
/// [Perille20]. Cells beyond the field count as empty. Draws without a path are repeated. The same number and settings
/// give the same course.
Course draw_course(std::uint64_t number, const CourseSettings& settings = {});

/// Returns the site of a course, with the goal as its mission and a scenario that has its optimal time.
ImportedSite site_of_course(const Course& course, const CourseSettings& settings, const std::string& name,
                            const std::string& robot);

}  // namespace patrol::importer
