#include "io/maps/map_server.h"

#include <algorithm>
#include <fstream>
#include <string_view>

#include "core/error.h"
#include "tests/fuzz/fuzz_input.h"

/// The input is a YAML, a line "---", and the image that it names, PGM or PNG: m.pgm.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("patrol_fuzz_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  constexpr std::string_view kBetween = "\n---\n";
  const std::size_t end = std::min(input.size(), input.find(kBetween));
  std::ofstream(folder / "m.yaml", std::ios::binary) << input.substr(0, end);
  std::ofstream(folder / "m.pgm", std::ios::binary) << input.substr(std::min(input.size(), end + kBetween.size()));
  try {
    const patrol::OccupancyGrid map = patrol::io::load_map(folder / "m.yaml");
    patrol::test::require(map.values().size() == map.geometry().size() && map.geometry().size() > 0,
                          "a map has its cells");
    for (const std::int8_t cell : map.values()) {
      patrol::test::require(cell >= patrol::kUnknown && cell <= patrol::kOccupied, "a cell is unknown or 0 to 100 %");
    }
  } catch (const patrol::InputError&) {}
  std::filesystem::remove_all(folder);
  return 0;
}
