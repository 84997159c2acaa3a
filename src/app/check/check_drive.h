#pragma once

#include <filesystem>
#include <functional>

#include "app/check/check_robot.h"
#include "app/check/drive_record.h"
#include "app/check/drive_segment.h"
#include "app/check/physics_probe.h"
#include "core/ground_truth.h"
#include "sim/simulator/simulator.h"

namespace patrol::app {

/// Drives a robot in a world by velocity commands and records the ground truth.
class CheckDrive {
 public:
  /// Called with the simulated time of every sample, s. Throws to abort the drive.
  using Observer = std::function<void(double time_s)>;

  /// The robot stands for `settle_s` before the record begins.
  CheckDrive(const CheckRobot& robot, const std::filesystem::path& world_xml, double settle_s, Observer observer);

  /// Drives a segment. Ends early if the robot falls over.
  void run(const DriveSegment& segment);

  const DriveRecord& record() const { return record_; }
  SimState state() const { return simulator_.state(); }

 private:
  void step(double factor, const DriveSegment& segment);
  void measure();
  void add_sample();
  double ahead_m() const;

  double tick_s_;
  Observer observer_;
  double turn_center_x_m_;
  sim::Simulator simulator_;
  PhysicsProbe probe_;
  DriveRecord record_;
  DriveSample next_;  ///< collects the values of the next sample
  Pose2 T_world_start_;
  double start_left_m_ = 0.0, start_right_m_ = 0.0;
  double last_yaw_rad_ = 0.0;
  double last_hull_contact_s_;
  long num_ticks_ = 0, ticks_per_sample_ = 1;
};

}  // namespace patrol::app
