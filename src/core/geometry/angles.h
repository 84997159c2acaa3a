#pragma once

#include <numbers>

/// Conversions between degrees and radians. Angles in the program are radians; degrees occur in settings, files and
/// messages.
///
/// The constants and the functions round differently: x * kDegree rounds pi / 180 first, to_rad(x) rounds x * pi first.
/// Replacing one by the other changes last bits, and with them the bytes of a log.
namespace patrol {

inline constexpr double kDegree = std::numbers::pi / 180.0;     ///< one degree, rad
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;  ///< one radian, deg

constexpr double to_rad(double angle_deg) { return angle_deg * std::numbers::pi / 180.0; }
constexpr double to_deg(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

}  // namespace patrol
