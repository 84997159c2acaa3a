#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "core/sensors/registry.h"
#include "tests/fuzz/fuzz_input.h"

namespace patrol::test {

/// Reads an input as a point cloud by `load` and checks that all points are finite and at most `max_per_byte` times as
/// many as the bytes of the input.
template <typename Load>
int check_points(const std::uint8_t* data, std::size_t size, std::size_t max_per_byte, Load load) {
  const MemoryFile file(data, size);
  try {
    const std::vector<ScannerPoint> points = load(file.path());
    require(points.size() <= max_per_byte * size, "the number of points is bounded by the size of the file");
    for (const auto& [x, y, z, intensity] : points) {
      require(std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && std::isfinite(intensity),
              "points are finite");
    }
  } catch (const InputError&) {}
  return 0;
}

}  // namespace patrol::test
