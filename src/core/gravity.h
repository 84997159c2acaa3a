#pragma once

namespace patrol {

/// Acceleration of gravity in all worlds, as in MuJoCo's default.
inline constexpr double kGravity_mps2 = 9.81;

}  // namespace patrol
