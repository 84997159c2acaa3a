#include "io/points/pcd.h"

#include "tests/fuzz/point_checks.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMaxPerByte = 30;  // compressed 88 times, with three bytes for a point
  return patrol::test::check_points(data, size, kMaxPerByte, patrol::io::load_pcd);
}
