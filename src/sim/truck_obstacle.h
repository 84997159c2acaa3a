#pragma once

#include <array>
#include <vector>

namespace patrol::sim {

/// Part of a parked dump truck, 7.6 x 2.5 x 3.0 m, equal to the world's own truck (tools/tunnel_objects.py). x toward
/// its nose, y to its left, z up from the ground; m.
struct TruckPart {
  enum class Shape { kBox, kWheel };
  Shape shape;
  std::array<double, 3> center;
  std::array<double, 3> half;  ///< half sizes; for a wheel: radius, half width, radius
  std::array<float, 4> rgba;
};

std::vector<TruckPart> truck_parts();

}  // namespace patrol::sim
