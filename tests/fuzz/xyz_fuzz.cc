#include "io/points/xyz.h"

#include "io/points/point_collector.h"
#include "tests/fuzz/point_checks.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return patrol::test::check_points(data, size, 1, [](const std::filesystem::path& file) {
    patrol::io::PointShift shift;
    std::string columns;
    return patrol::io::load_shifted_xyz(file, shift, columns);
  });
}
