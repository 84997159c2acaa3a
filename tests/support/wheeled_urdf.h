#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

namespace patrol::test {

/// Wheel of a synthetic robot description. Defaults: a driven wheel on the chassis.
struct UrdfWheel {
  std::string name;
  double x_m, y_m;
  double radius_m = 0.15;
  double width_m = 0.08;
  bool is_driven = true;
  double steering_limit_rad = 0.0;  ///< greater than 0: on a steering joint NAME_steer
  bool is_caster = false;           ///< on a joint NAME_fork without limits
  std::string axis = "0 1 0";
};

/// Synthetic robot on wheels with a chassis of a box. The origin of base_link is `height_m` above the ground.
struct UrdfRobot {
  std::vector<UrdfWheel> wheels;
  double mass_kg = 40.0;            ///< chassis
  double center_of_mass_x_m = 0.0;  ///< chassis
  double height_m = 0.2;
  std::string chassis_box = "0.8 0.4 0.2";
  double effort_nm = 30.0;
  double speed_radps = 20.0;
  double bearing_friction_nm = 0.0;

  std::string text() const;
};

/// A robot with four driven wheels that are not steered.
inline UrdfRobot skid_steer_urdf(double wheelbase_m, double gauge_m) {
  UrdfRobot robot;
  for (const double x : {0.5, -0.5}) {
    for (const double y : {0.5, -0.5})
      robot.wheels.push_back(
          {.name = fmt::format("w{}", robot.wheels.size()), .x_m = x * wheelbase_m, .y_m = y * gauge_m});
  }
  return robot;
}

/// Two driven wheels and a caster behind them.
inline UrdfRobot differential_urdf() {
  return {.wheels = {{.name = "port", .x_m = 0.1, .y_m = 0.25},
                     {.name = "starboard", .x_m = 0.1, .y_m = -0.25, .axis = "0 -1 0"},
                     {.name = "trailing",
                      .x_m = -0.35,
                      .y_m = 0.0,
                      .radius_m = 0.06,
                      .width_m = 0.04,
                      .is_driven = false,
                      .is_caster = true}}};
}

/// Front wheels on steering joints, driven rear axle.
inline UrdfRobot ackermann_urdf(double wheelbase_m, double gauge_m, double steering_limit_rad) {
  return {.wheels = {{.name = "fl",
                      .x_m = wheelbase_m,
                      .y_m = 0.5 * gauge_m,
                      .is_driven = false,
                      .steering_limit_rad = steering_limit_rad},
                     {.name = "fr",
                      .x_m = wheelbase_m,
                      .y_m = -0.5 * gauge_m,
                      .is_driven = false,
                      .steering_limit_rad = steering_limit_rad},
                     {.name = "rl", .x_m = 0.0, .y_m = 0.5 * gauge_m},
                     {.name = "rr", .x_m = 0.0, .y_m = -0.5 * gauge_m}},
          .chassis_box = "0.3 0.3 0.2"};
}

inline std::string inertial(double mass_kg, double ixx, double iyy, double izz, double x_m = 0.0) {
  return fmt::format(
      R"(<inertial><origin xyz="{} 0 0"/><mass value="{}"/>
      <inertia ixx="{}" ixy="0" ixz="0" iyy="{}" iyz="0" izz="{}"/></inertial>)",
      x_m, mass_kg, ixx, iyy, izz);
}

inline std::string UrdfRobot::text() const {
  std::string links =
      fmt::format(R"(<link name="base_link">{}<collision><geometry><box size="{}"/></geometry></collision></link>)",
                  inertial(mass_kg, 0.02 * mass_kg, 0.05 * mass_kg, 0.06 * mass_kg, center_of_mass_x_m), chassis_box);
  for (const UrdfWheel& wheel : wheels) {
    std::string parent = "base_link",
                origin = fmt::format("{} {} {:.6g}", wheel.x_m, wheel.y_m, wheel.radius_m - height_m);
    if (wheel.is_caster || wheel.steering_limit_rad > 0.0) {
      parent = wheel.name + "_carrier";
      links += fmt::format(R"(<link name="{}">{}</link>)", parent, inertial(0.3, 0.001, 0.001, 0.001));
      links += wheel.is_caster
                   ? fmt::format(
                         R"(<joint name="{}_fork" type="continuous"><parent link="base_link"/><child link="{}"/>
                         <origin xyz="{}"/><axis xyz="0 0 1"/></joint>)",
                         wheel.name, parent, origin)
                   : fmt::format(
                         R"(<joint name="{}_steer" type="revolute"><parent link="base_link"/><child link="{}"/>
                         <origin xyz="{}"/><axis xyz="0 0 1"/><limit lower="{}" upper="{}" effort="20" velocity="3"/></joint>)",
                         wheel.name, parent, origin, -wheel.steering_limit_rad, wheel.steering_limit_rad);
      origin = wheel.is_caster ? "-0.03 0 0" : "0 0 0";
    }
    const std::string limit =
        wheel.is_driven ? fmt::format(R"(<limit effort="{}" velocity="{}"/>)", effort_nm, speed_radps) : "";
    links += fmt::format(
        R"(<joint name="{0}_roll" type="continuous"><parent link="{1}"/><child link="{0}"/><origin xyz="{2}"/>
        <axis xyz="{3}"/>{4}<dynamics friction="{5}"/></joint>
        <link name="{0}">{6}<collision><origin rpy="1.5707963267948966 0 0"/><geometry>
        <cylinder radius="{7}" length="{8}"/></geometry></collision></link>)",
        wheel.name, parent, origin, wheel.axis, limit, bearing_friction_nm,
        inertial(1.0, 0.25 * wheel.radius_m * wheel.radius_m, 0.5 * wheel.radius_m * wheel.radius_m,
                 0.25 * wheel.radius_m * wheel.radius_m),
        wheel.radius_m, wheel.width_m);
  }
  for (const char* frame : {"imu", "lidar"}) {
    links += fmt::format(
        R"(<joint name="{0}_joint" type="fixed"><parent link="base_link"/><child link="{0}"/></joint><link name="{0}"/>)",
        frame);
  }
  return R"(<?xml version="1.0"?><robot name="synthetic">)" + links + "</robot>";
}

}  // namespace patrol::test
