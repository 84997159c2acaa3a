#pragma once

#include <string>

/// Worlds of the check drive as MJCF. All surfaces are ground (sim/simulator/simulator.cc); the friction is that of the
/// robot. The robot starts at the origin and drives along x.
namespace patrol::app {

inline constexpr double kRampAngle_deg = 10.0;
inline constexpr double kRampLength_m = 3.0;   ///< length along the slope, up and down
inline constexpr double kRampTop_m = 2.0;      ///< level part between the slopes
inline constexpr double kStepHeight_m = 0.03;  ///< height of each step
inline constexpr int kNumSteps = 3;
inline constexpr double kStepSpacing_m = 0.5;
inline constexpr double kStepTop_m = 1.5;  ///< level part between the steps up and down

/// World with its extent along x.
struct CheckWorld {
  std::string mjcf;
  double begin_x_m = 0.0;  ///< begin of the obstacle
  double end_x_m = 0.0;    ///< end of the obstacle
};

/// Level ground.
CheckWorld plane_world();
/// Ramp up, level top and ramp down that begin at `begin_x_m`.
CheckWorld ramp_world(double begin_x_m);
/// Steps up that begin at `begin_x_m`, a level top, and the same steps down.
CheckWorld steps_world(double begin_x_m);
/// Long slope up that begins at `begin_x_m`.
CheckWorld slope_world(double begin_x_m);

}  // namespace patrol::app
