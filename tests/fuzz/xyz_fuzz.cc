#include "io/points/xyz.h"

#include <cmath>

#include "core/error.h"
#include "io/points/point_collector.h"
#include "tests/fuzz/fuzz_input.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using patrol::test::require;
  const patrol::test::MemoryFile file(data, size);
  try {
    patrol::io::PointShift shift;
    std::string columns;
    const std::vector<patrol::ScannerPoint> points = patrol::io::load_shifted_xyz(file.path(), shift, columns);
    require(points.size() <= size, "each point takes a byte at least");
    for (const auto& [x, y, z, intensity] : points) {
      require(std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && std::isfinite(intensity),
              "points are finite");
    }
  } catch (const patrol::InputError&) {}
  return 0;
}
