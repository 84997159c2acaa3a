#include "io/points/ply.h"

#include "tests/fuzz/point_checks.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return patrol::test::check_points(data, size, 1, patrol::io::load_ply);
}
