#pragma once

#include <string>
#include <vector>

#include "app/check/check_robot.h"
#include "app/check/drive_record.h"
#include "app/check/figure.h"
#include "app/check/maneuver.h"

/// Figures of the maneuvers with their limits. Each function is the `measure` of a maneuver.
namespace patrol::app {

std::vector<Figure> measure_stand(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record);
std::vector<Figure> measure_straight(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record);
std::vector<Figure> measure_sideways(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record);
std::vector<Figure> measure_loop(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record);
std::vector<Figure> measure_turn(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record);
std::vector<Figure> measure_circle(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record);
std::vector<Figure> measure_ramp(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record);
std::vector<Figure> measure_steps(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record);
std::vector<Figure> measure_emergency_stop(const CheckRobot& robot, const Maneuver& maneuver,
                                           const DriveRecord& record);
std::vector<Figure> measure_slope(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record);

/// Returns why a maneuver failed: the fall first, then the figures out of their limits; empty if it passed.
std::vector<std::string> failures_of(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record,
                                     const std::vector<Figure>& figures);

}  // namespace patrol::app
