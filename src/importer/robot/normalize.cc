#include "importer/robot/normalize.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "importer/robot/link_builder.h"
#include "importer/robot/normalize_casters.h"
#include "importer/robot/normalize_chassis.h"
#include "importer/robot/normalize_checks.h"
#include "importer/robot/normalize_drive.h"
#include "importer/robot/normalize_frame.h"
#include "importer/robot/normalize_legs.h"
#include "importer/robot/normalize_lookalikes.h"
#include "importer/robot/normalize_scan.h"
#include "importer/robot/normalize_sensors.h"
#include "importer/robot/normalize_size.h"
#include "importer/robot/normalize_supports.h"
#include "importer/robot/normalize_wheels.h"
#include "importer/robot/robot_layout.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

/// Refuses options that name unknown links, frames, drives or directions.
void check_options(const SourceRobot& source, const NormalizeOptions& options) {
  if (!options.base_link.empty() && source.find_link(options.base_link) == nullptr)
    throw InputError(fmt::format("{}: base link {}: unknown link", source.file, io::on_one_line(options.base_link)));
  for (const std::string& link : options.casters) {
    if (source.find_link(link) == nullptr)
      throw InputError(fmt::format("{}: caster {}: unknown link", source.file, io::on_one_line(link)));
  }
  for (const auto& [frame, link] : options.frames) {
    if (std::find(kSensorFrames.begin(), kSensorFrames.end(), frame) == kSensorFrames.end()) {
      throw InputError(fmt::format("{}: frame {}: unknown sensor frame: must be {}", source.file,
                                   io::on_one_line(frame), list_of({kSensorFrames.begin(), kSensorFrames.end()})));
    }
    if (source.find_link(link) == nullptr)
      throw InputError(fmt::format("{}: frame {}: unknown link {}", source.file, frame, io::on_one_line(link)));
  }
  const std::set<std::string> drives = {"", "differential", "ackermann", "mecanum", "legs"};
  if (!drives.contains(options.drive)) {
    throw InputError(fmt::format("{}: drive {}: must be differential, ackermann, mecanum or legs", source.file,
                                 io::on_one_line(options.drive)));
  }
  const std::set<std::string> directions = {"", "x", "-x", "y", "-y"};
  if (!directions.contains(options.forward)) {
    throw InputError(
        fmt::format("{}: forward {}: must be x, -x, y or -y", source.file, io::on_one_line(options.forward)));
  }
}

/// Joins assumptions that differ in the subject only.
std::vector<Assumption> joined(const std::vector<Assumption>& assumptions) {
  std::vector<Assumption> rows;
  for (const Assumption& next : assumptions) {
    const auto same = std::find_if(rows.begin(), rows.end(), [&next](const Assumption& row) {
      return row.text == next.text && row.override_with == next.override_with;
    });
    if (same == rows.end()) rows.push_back(next);
    else if (same->subject != next.subject) same->subject += ", " + next.subject;
  }
  return rows;
}

/// Decides what the links of the result follow from.
RobotLayout decide_layout(const SourceRobot& source, const NormalizeOptions& options, NormalizedRobot& robot) {
  std::vector<Assumption>& rows = robot.assumptions;
  RobotLayout layout{.source = source, .T_root_link = link_poses(source)};
  layout.extent = measure_extent(layout);
  check_centers(layout);
  find_drive(layout, options, rows);
  choose_base(layout, options, rows);
  if (options.base_link.empty()) robot.source_links["base_link"] = layout.base;
  if (layout.drive == DriveType::kLegs) {
    choose_legged_frame(layout, options, rows);
    report_frozen_joints(layout, rows);
    return layout;
  }
  choose_wheeled_frame(layout, options, rows);
  choose_motors(layout, rows);
  release_fixed_casters(layout, rows);
  if (const auto rollers = choose_rollers(layout, options, rows)) {
    robot.roller_pattern = rollers->pattern;
    robot.roller_angle_rad = rollers->angle_rad;
  }
  report_frozen_joints(layout, rows);
  refuse_unturned_wheels(layout, options.casters);
  find_supports(layout, rows);
  return layout;
}

}  // namespace

NormalizedRobot normalize(const SourceRobot& source, const NormalizeOptions& options) {
  NormalizedRobot robot{.name = options.name.empty() ? source.name : options.name, .assumptions = source.assumptions};
  check_options(source, options);
  const RobotLayout layout = decide_layout(source, options, robot);
  robot.drive = layout.drive;
  LinkBuilder links(layout, robot);
  add_chassis(layout, links, robot);
  if (layout.drive == DriveType::kLegs) {
    add_legs(layout, links, robot);
  } else {
    add_wheels(layout, links, robot);
    add_casters(layout, links, robot);
    report_frictions(layout, robot);
  }
  add_sensors(layout, options, links, robot);
  choose_scan_band(layout, robot);
  check_normalized(layout, robot);
  robot.assumptions = joined(robot.assumptions);
  measure_size(layout, robot);
  return robot;
}

}  // namespace patrol::importer
