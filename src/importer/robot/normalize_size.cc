#include "importer/robot/normalize_size.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "importer/robot/wheel_motors.h"

namespace patrol::importer {
namespace {

/// Rectangle around the chassis and the wheels, in the base.
struct RobotOutline {
  double front_m = -std::numeric_limits<double>::infinity(), rear_m = -front_m, left_m = front_m, right_m = rear_m;
};

RobotOutline outline_of(const RobotLayout& layout) {
  RobotOutline around;
  for (const std::string& name : layout.chassis) {
    for (const Shape& shape : bounding_shapes(layout.source.link(name))) {
      for (const Eigen::Vector3d& point : outline(shape)) {
        const Eigen::Vector3d p = layout.T_base(name) * point;
        around.front_m = std::max(around.front_m, p.x());
        around.rear_m = std::min(around.rear_m, p.x());
        around.left_m = std::max(around.left_m, p.y());
        around.right_m = std::min(around.right_m, p.y());
      }
    }
  }
  for (const FoundWheel& wheel : layout.found.wheels) {
    around.front_m = std::max(around.front_m, wheel.center_m.x() + wheel.radius_m);
    around.rear_m = std::min(around.rear_m, wheel.center_m.x() - wheel.radius_m);
    around.left_m = std::max(around.left_m, wheel.center_m.y() + 0.5 * wheel.width_m);
    around.right_m = std::min(around.right_m, wheel.center_m.y() - 0.5 * wheel.width_m);
  }
  return around;
}

/// Returns the smallest turning radius by the steered wheels; 0 without any.
double turning_radius_m(const RobotLayout& layout) {
  double fixed_x = 0.0, num_fixed = 0.0, steered_x = 0.0, num_steered = 0.0, max_angle = kSteering_rad;
  for (const FoundWheel& wheel : layout.found.wheels) {
    if (wheel.carrier_type == CarrierType::kSteering) {
      steered_x += wheel.center_m.x();
      ++num_steered;
      if (const auto limits = wheel.carrier->steering_limits())
        max_angle = std::min(std::abs(limits->first), std::abs(limits->second));
    } else if (wheel.carrier_type == CarrierType::kNone) {
      fixed_x += wheel.center_m.x();
      ++num_fixed;
    }
  }
  if (num_steered <= 0.0) return 0.0;
  const double wheelbase_m = std::abs(steered_x / num_steered - fixed_x / num_fixed);
  return wheelbase_m / std::tan(std::clamp(max_angle, kMinSteering_rad, 1.5));
}

/// Chooses the distance of a robot with steered wheels from keep-out lines such as curbs, from the smaller side of its
/// outline.
void choose_keep_out_margin(double width_m, NormalizedRobot& robot) {
  // As models/cart, whose discs are 0.17 m from its sides and which keeps 0.30 m. The default is 0.2 m.
  constexpr double kBeside_m = 0.13, kDefault_m = 0.2, kMax_m = 1.0;
  const double disc_m = 0.25 * width_m;  // from the centers of two rows of discs to the side
  robot.keep_out_margin_m = std::clamp(std::floor(100.0 * (disc_m + kBeside_m)) / 100.0, kDefault_m, kMax_m);
  robot.assumptions.push_back(
      {"keep-out lines",
       fmt::format("stay {:.2f} m from the centers of the discs of its outline, and so {:.2f} m from its sides",
                   robot.keep_out_margin_m, robot.keep_out_margin_m - disc_m),
       fmt::format("stack.navigation.costmap.keep_out_margin_m in {}.yaml", robot.name)});
}

}  // namespace

void measure_size(const RobotLayout& layout, NormalizedRobot& robot) {
  const RobotOutline around = outline_of(layout);
  const double length_m = around.front_m - around.rear_m, width_m = around.left_m - around.right_m;
  robot.length_m = length_m;
  if (layout.drive == DriveType::kAckermann) choose_keep_out_margin(std::min(width_m, length_m), robot);
  robot.min_turning_radius_m = turning_radius_m(layout);
}

}  // namespace patrol::importer
