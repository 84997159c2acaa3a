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
<headlight ambient="0.40 0.41 0.43" diffuse="0.12 0.12 0.12" specular="0 0 0"/>
</visual>
<asset>
<texture name="sky" type="skybox" builtin="gradient" rgb1="0.93 0.95 0.97" rgb2="0.62 0.74 0.86" width="256" height="256"/>
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

std::string plane(double slope_deg) {
  return fmt::format("<geom name=\"ground\" type=\"plane\" size=\"{0} {0} 1\" euler=\"0 {1} 0\"/>\n", kPlaneHalf_m,
                     -slope_deg);
}

}  // namespace

CheckWorld plane_world() { return {.mjcf = world_of(plane(0.0))}; }

CheckWorld slope_world() { return {.mjcf = world_of(plane(kRampAngle_deg))}; }

// The upper faces of the boards meet at the edges of the ramp; the boards hang below them.
CheckWorld ramp_world(double begin_x_m) {
  const double a = to_rad(kRampAngle_deg), half_m = 0.5 * kThickness_m;
  const double run_m = kRampLength_m * std::cos(a), rise_m = kRampLength_m * std::sin(a);
  const double top_x_m = begin_x_m + run_m, down_x_m = top_x_m + kRampTop_m;
  const double board_z_m = 0.5 * rise_m - half_m * std::cos(a);
  const std::string geoms =
      plane(0.0) +
      fmt::format(
          "<geom name=\"ground_up\" type=\"box\" size=\"{0} {1} {2}\" pos=\"{3} 0 {4}\" euler=\"0 {5} 0\" "
          "material=\"board\"/>\n"
          "<geom name=\"ground_top\" type=\"box\" size=\"{6} {1} {7}\" pos=\"{8} 0 {7}\" material=\"top\"/>\n"
          "<geom name=\"ground_down\" type=\"box\" size=\"{0} {1} {2}\" pos=\"{9} 0 {4}\" euler=\"0 {10} 0\" "
          "material=\"board\"/>\n",
          0.5 * kRampLength_m, kHalfWidth_m, half_m, begin_x_m + 0.5 * run_m + half_m * std::sin(a), board_z_m,
          -kRampAngle_deg, 0.5 * kRampTop_m, 0.5 * rise_m, top_x_m + 0.5 * kRampTop_m,
          down_x_m + 0.5 * run_m - half_m * std::sin(a), kRampAngle_deg);
  return {.mjcf = world_of(geoms), .begin_x_m = begin_x_m, .end_x_m = down_x_m + run_m};
}

CheckWorld steps_world(double begin_x_m) {
  const double end_x_m = begin_x_m + (kNumSteps - 1) * kStepSpacing_m + kStepTop_m;
  std::string geoms = plane(0.0);
  for (int step = 0; step < kNumSteps; ++step) {
    const double from_x_m = begin_x_m + step * kStepSpacing_m;
    const double to_x_m = step + 1 < kNumSteps ? from_x_m + kStepSpacing_m : end_x_m;
    geoms += fmt::format(
        "<geom name=\"ground_step_{}\" type=\"box\" size=\"{} {} {}\" pos=\"{} 0 {}\" material=\"{}\"/>\n", step + 1,
        0.5 * (to_x_m - from_x_m), kHalfWidth_m, 0.5 * (step + 1) * kStepHeight_m, 0.5 * (from_x_m + to_x_m),
        0.5 * (step + 1) * kStepHeight_m, step % 2 == 0 ? "board" : "top");
  }
  return {.mjcf = world_of(geoms), .begin_x_m = begin_x_m, .end_x_m = end_x_m};
}

}  // namespace patrol::app
