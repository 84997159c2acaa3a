#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "importer/robot/normalize.h"
#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Rollers of a mecanum drive, as the settings of wheel_drive.
struct RollerChoice {
  std::string pattern = "x";
  double angle_rad = 0.25 * std::numbers::pi;
};

/// Returns the message about a robot all of whose wheels are steered.
std::string all_steered(std::size_t num_wheels);

/// Refuses the wheels that were found. Names the link with a motor that is no wheel and carries none, which often is
/// the reason; without one, the joint; without a joint, only the file.
[[noreturn]] void fail_for_wheels(const RobotLayout& layout, const SourceJoint* joint, const std::string& what);

/// Finds the legs or the wheels and the type of the drive.
void find_drive(RobotLayout& layout, const NormalizeOptions& options, std::vector<Assumption>& rows);

/// Chooses the wheels with motors. The wheels are in the base.
void choose_motors(RobotLayout& layout, std::vector<Assumption>& rows);

/// Checks the wheels of a mecanum drive and returns the pattern of the rollers by their joints; none for other drives.
std::optional<RollerChoice> choose_rollers(const RobotLayout& layout, const NormalizeOptions& options,
                                           std::vector<Assumption>& rows);

/// Reports movable joints of the file that are neither those of wheels nor of legs.
void report_frozen_joints(const RobotLayout& layout, std::vector<Assumption>& rows);

}  // namespace patrol::importer
