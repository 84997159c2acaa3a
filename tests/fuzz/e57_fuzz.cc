#include "io/points/e57.h"

#include "tests/fuzz/point_checks.h"
#include "tests/io/e57_writer.h"

/// The input is the content of the pages; the checksums are added.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string pages = patrol::test::with_checksums(std::string(reinterpret_cast<const char*>(data), size));
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(pages.data());
  constexpr std::size_t kMaxPointsPerByte = 8;
  return patrol::test::check_points(bytes, pages.size(), kMaxPointsPerByte, [](const std::filesystem::path& file) {
    return patrol::io::joined_points(patrol::io::load_e57(file)).points;
  });
}
