#include "app/check/check_world.h"

#include <cmath>

#include <fmt/format.h>

#include "core/geometry/angles.h"

namespace patrol::app {
namespace {

constexpr double kHalfWidth_m = 4.0;   // of ramp and steps
constexpr double kThickness_m = 0.2;   // of the boards of the ramp
constexpr double kPlaneHalf_m = 50.0;  // half size of the ground

std::string world_of(const std::string& geoms) {
  return R"(<mujoco model="check">
<compiler angle="degree"/>
<option timestep="0.002" cone="elliptic" impratio="10" integrator="Euler" solver="Newton"/>
<statistic extent="10" center="3 0 0"/>
<visual>
<global offwidth="1920" offheight="1080" fovy="50"/>
<quality shadowsize="2048" offsamples="0"/>
<map znear="0.003" zfar="20" fogstart="2" fogend="8" shadowclip="0.3" haze="0"/>
<rgba fog="0.80 0.86 0.92 1" haze="0.80 0.86 0.92 1"/>
<headlight ambient="0.40 0.41 0.43" diffuse="0.12 0.12 0.12" specular="0 0 0"/>
</visual>
<asset>
<texture name="sky" type="skybox" builtin="gradient" rgb1="0.93 0.95 0.97" rgb2="0.62 0.74 0.86" width="256" height="1536"/>
<texture name="squares" type="2d" builtin="checker" rgb1="0.60 0.61 0.60" rgb2="0.66 0.67 0.66" mark="edge" markrgb="0.74 0.75 0.74" width="256" height="256"/>
<material name="floor" texture="squares" texuniform="true" texrepeat="1 1" specular="0" shininess="0"/>
<material name="board" rgba="0.78 0.66 0.47 1" specular="0" shininess="0"/>
<material name="top" rgba="0.84 0.73 0.55 1" specular="0" shininess="0"/>
</asset>
<default><geom contype="1" conaffinity="2" group="0" material="floor"/></default>
<worldbody>
<light name="sun" directional="true" pos="0 0 20" dir="-0.35 0.45 -0.82" diffuse="0.62 0.60 0.56" specular="0.1 0.1 0.1" castshadow="true"/>
)" + geoms +
         "</worldbody>\n</mujoco>\n";
}

std::string plane() { return fmt::format("<geom name=\"ground\" type=\"plane\" size=\"{0} {0} 1\"/>\n", kPlaneHalf_m); }

/// Board whose upper face rises, or falls with a negative angle, from (`from_x_m`, 0, `from_z_m`) over `length_m`.
std::string board(const char* name, double from_x_m, double from_z_m, double length_m, double angle_deg) {
  const double a = to_rad(angle_deg), half_m = 0.5 * kThickness_m;
  return fmt::format(
      "<geom name=\"{}\" type=\"box\" size=\"{} {} {}\" pos=\"{} 0 {}\" euler=\"0 {} 0\" material=\"board\"/>\n", name,
      0.5 * length_m, kHalfWidth_m, half_m, from_x_m + 0.5 * length_m * std::cos(a) + half_m * std::sin(a),
      from_z_m + 0.5 * length_m * std::sin(a) - half_m * std::cos(a), -angle_deg);
}

}  // namespace

CheckWorld plane_world() { return {.mjcf = world_of(plane())}; }

CheckWorld ramp_world(double begin_x_m) {
  const double a = to_rad(kRampAngle_deg);
  const double run_m = kRampLength_m * std::cos(a), rise_m = kRampLength_m * std::sin(a);
  const double top_x_m = begin_x_m + run_m, down_x_m = top_x_m + kRampTop_m;
  const std::string top =
      fmt::format("<geom name=\"ground_top\" type=\"box\" size=\"{} {} {}\" pos=\"{} 0 {}\" material=\"top\"/>\n",
                  0.5 * kRampTop_m, kHalfWidth_m, 0.5 * rise_m, top_x_m + 0.5 * kRampTop_m, 0.5 * rise_m);
  return {.mjcf = world_of(plane() + board("ground_up", begin_x_m, 0.0, kRampLength_m, kRampAngle_deg) + top +
                           board("ground_down", down_x_m, rise_m, kRampLength_m, -kRampAngle_deg)),
          .begin_x_m = begin_x_m,
          .end_x_m = down_x_m + run_m};
}

CheckWorld slope_world(double begin_x_m) {
  constexpr double kLength_m = 12.0;
  return {.mjcf = world_of(plane() + board("ground_slope", begin_x_m, 0.0, kLength_m, kRampAngle_deg)),
          .begin_x_m = begin_x_m,
          .end_x_m = begin_x_m + kLength_m * std::cos(to_rad(kRampAngle_deg))};
}

CheckWorld steps_world(double begin_x_m) {
  const double flight_m = (kNumSteps - 1) * kStepSpacing_m, end_x_m = begin_x_m + 2.0 * flight_m + kStepTop_m;
  std::string geoms = plane();
  for (int step = 0; step < kNumSteps; ++step) {
    const double half_length_m = 0.5 * (end_x_m - begin_x_m) - step * kStepSpacing_m;
    geoms +=
        fmt::format("<geom name=\"ground_step_{}\" type=\"box\" size=\"{} {} {}\" pos=\"{} 0 {}\" material=\"{}\"/>\n",
                    step + 1, half_length_m, kHalfWidth_m, 0.5 * kStepHeight_m, 0.5 * (begin_x_m + end_x_m),
                    (step + 0.5) * kStepHeight_m, step % 2 == 0 ? "board" : "top");
  }
  return {.mjcf = world_of(geoms), .begin_x_m = begin_x_m, .end_x_m = end_x_m};
}

}  // namespace patrol::app
