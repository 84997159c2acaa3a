#include "importer/robot/wheel_motors.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "core/gravity.h"

namespace patrol::importer {
namespace {

constexpr double kAssumedSpeedRadius_m = 0.1;  // of the smallest wheels at kAssumedSpeed_mps
constexpr double kPlaceholderRatio = 10.0;     // of a speed limit to the assumed one
constexpr double kSlowRatio = 0.2;             // likewise, below which the limit is probably not that of the robot
constexpr double kTorqueReserve = 1.5;  // loads differ, and wheels that skid sideways need the torque of friction

/// Returns the torque of the friction of a tire, N m, if the driven wheels carry the robot.
double traction_of(const FoundWheel& wheel, std::size_t num_driven, double mass_kg) {
  return kFriction * mass_kg * kGravity_mps2 * wheel.radius_m / static_cast<double>(num_driven);
}

/// Returns the speed limit of a drive whose file has none: that of small robots falls with the square root of their
/// size.
double assumed_speed_mps(double wheel_radius_m) {
  return kAssumedSpeed_mps * std::sqrt(std::min(1.0, wheel_radius_m / kAssumedSpeedRadius_m));
}

}  // namespace

Motor motor_of(const FoundWheel& wheel, std::size_t num_driven, double mass_kg, std::vector<Assumption>& rows) {
  Motor motor{.effort_nm = wheel.joint->effort.value_or(0.0), .velocity_radps = wheel.joint->velocity.value_or(0.0)};
  const double traction_nm = traction_of(wheel, num_driven, mass_kg);
  if (motor.effort_nm <= 0.0) {
    motor.effort_nm = kTorqueReserve * traction_nm;
    rows.push_back({wheel.joint->name,
                    fmt::format("torque limit {:.3g} N m: {} times that of friction {} on all driven wheels",
                                motor.effort_nm, kTorqueReserve, kFriction),
                    "<limit effort> of the joint"});
  } else if (motor.effort_nm > 20.0 * traction_nm) {
    rows.push_back({wheel.joint->name,
                    fmt::format("torque limit {:.3g} N m of the file is kept: {:.0f} times the friction limit",
                                motor.effort_nm, motor.effort_nm / traction_nm),
                    "<limit effort> of the joint"});
  }
  if (motor.velocity_radps <= 0.0) {
    const double speed_mps = assumed_speed_mps(wheel.radius_m);
    motor.velocity_radps = speed_mps / wheel.radius_m;
    rows.push_back({wheel.joint->name,
                    fmt::format("speed limit {:.3g} rad/s: {:.2g} m/s", motor.velocity_radps, speed_mps),
                    "<limit velocity> of the joint"});
  }
  return motor;
}

double speed_of(const FoundWheel& wheel, const Motor& motor, std::vector<Assumption>& rows) {
  const double limit_mps = motor.velocity_radps * wheel.radius_m, assumed_mps = assumed_speed_mps(wheel.radius_m);
  if (limit_mps < kSlowRatio * assumed_mps) {
    rows.push_back({wheel.joint->name,
                    fmt::format("speed limit {:.4g} rad/s of the file is {:.2g} m/s: slow, a robot of its size without "
                                "a limit drives at {:.2g} m/s",
                                motor.velocity_radps, limit_mps, assumed_mps),
                    "<limit velocity> of the joint, or its command interface"});
  }
  if (limit_mps <= kPlaceholderRatio * assumed_mps) return limit_mps;
  rows.push_back(
      {wheel.joint->name,
       fmt::format(
           "speed limit {:.4g} rad/s of the file, {:.2g} m/s, is kept for the motor; the robot drives at {:.2g} m/s",
           motor.velocity_radps, limit_mps, assumed_mps),
       "wheel_drive.max_speed_mps"});
  return assumed_mps;
}

void reduce_losses(const FoundWheel& wheel, std::size_t num_driven, double mass_kg, NormalizedJoint& driven,
                   std::vector<Assumption>& rows) {
  const Motor& motor = *driven.motor;
  const double speed_radps = std::min(motor.velocity_radps, kAssumedSpeed_mps / wheel.radius_m);
  const double traction_nm = traction_of(wheel, num_driven, mass_kg);
  const double loss_nm = driven.damping * speed_radps + driven.friction;
  const double limit_nm = std::min(motor.effort_nm, traction_nm);
  if (loss_nm <= limit_nm) return;
  constexpr double kLoss = 0.25;  // to the limit
  const double factor = kLoss * limit_nm / loss_nm;
  driven.damping *= factor;
  driven.friction *= factor;
  rows.push_back(
      {wheel.joint->name,
       fmt::format("damping and friction take {:.3g} N m at {:.3g} rad/s, more than the {} of {:.3g} N m: reduced to a "
                   "quarter of it",
                   loss_nm, speed_radps, traction_nm < motor.effort_nm ? "friction of the tire" : "torque limit",
                   limit_nm),
       "<dynamics> and <limit effort velocity> of the joint"});
}

JointRange steering_range_of(const SourceRobot& source, const SourceJoint& joint, std::vector<Assumption>& rows) {
  const auto limits = joint.steering_limits();
  if (!limits) {
    rows.push_back({joint.name,
                    fmt::format("steering angle is limited to {} rad: the joint has no limits", kSteering_rad),
                    joint.type == JointType::kContinuous ? "type revolute and <limit lower upper> of the joint"
                                                         : "<limit lower upper> of the joint"});
    return {-kSteering_rad, kSteering_rad};
  }
  const auto& [lower, upper] = *limits;
  if (lower > -kMinSteering_rad || upper < kMinSteering_rad) {
    source.fail(joint.line, joint.name,
                fmt::format("steering range {:.3g} to {:.3g} rad: must reach at least {} rad to both sides", lower,
                            upper, kMinSteering_rad));
  }
  if (joint.is_endless())
    rows.push_back({joint.name,
                    fmt::format("steering angle is {:.3g} to {:.3g} rad by <limit>, although its type is continuous",
                                lower, upper),
                    "type revolute of the joint"});
  return {lower, upper};
}

Motor steering_motor_of(const FoundWheel& wheel, std::size_t num_wheels, double mass_kg,
                        std::vector<Assumption>& rows) {
  const SourceJoint& joint = *wheel.carrier;
  Motor motor{joint.effort.value_or(0.0), joint.velocity.value_or(0.0)};
  if (motor.effort_nm <= 0.0) {
    motor.effort_nm =
        std::max(2.0, kFriction * mass_kg * kGravity_mps2 / static_cast<double>(num_wheels) * wheel.width_m);
    rows.push_back(
        {joint.name,
         fmt::format("torque limit {:.3g} N m: friction {} on the width of the tire", motor.effort_nm, kFriction),
         "<limit effort> of the joint"});
  }
  if (motor.velocity_radps <= 0.0) {
    motor.velocity_radps = 2.0;
    rows.push_back({joint.name, "speed limit 2 rad/s", "<limit velocity> of the joint"});
  }
  return motor;
}

}  // namespace patrol::importer
