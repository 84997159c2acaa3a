// Writes point clouds for other programs, and says what it reads in theirs; for point_clouds_test.py.
// usage: cloud_files write FOLDER | cloud_files read FILE
#include <cstdio>
#include <filesystem>
#include <string>

#include "core/error.h"
#include "io/points/e57.h"
#include "io/points/pcd.h"
#include "io/points/ply.h"

namespace {

std::vector<patrol::ScannerPoint> sample() {
  std::vector<patrol::ScannerPoint> points;
  for (int i = 0; i < 1000; ++i) {
    const auto t = static_cast<float>(i);
    points.push_back(
        {.x = 0.125F * t, .y = -1.5F * t, .z = 1.0F / (1.0F + t), .intensity = static_cast<float>(i % 256)});
  }
  return points;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::filesystem::path path = argv[2];
  if (argv[1] == std::string("write")) {
    patrol::io::save_ply(path / "cloud.ply", sample(), "tests/interop");
    patrol::io::save_pcd(path / "cloud.pcd", sample());
    return 0;
  }
  try {
    const auto points = path.extension() == ".ply"   ? patrol::io::load_ply(path)
                        : path.extension() == ".e57" ? patrol::io::joined_points(patrol::io::load_e57(path)).points
                                                     : patrol::io::load_pcd(path);
    for (const auto& [x, y, z, intensity] : points) std::printf("%.9g %.9g %.9g %.9g\n", x, y, z, intensity);
  } catch (const patrol::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
