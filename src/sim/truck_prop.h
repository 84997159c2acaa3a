#pragma once

#include <array>
#include <vector>

namespace patrol::sim {

/// A part of a parked dump truck, 7.6 x 2.5 x 3.0 m, the sister of the world's own (tools/make_tunnel). x towards its nose, y to its
/// left, z up from the ground; m.
struct TruckPart {
  enum class Shape { kBox, kWheel };
  Shape shape;
  std::array<double, 3> centre;
  std::array<double, 3> half;  ///< of a wheel: radius, half its width, radius
  std::array<float, 4> rgba;
};

std::vector<TruckPart> truck_parts();

}  // namespace patrol::sim
