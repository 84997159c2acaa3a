#include "io/maps/moving_ai.h"

#include <cmath>

#include "core/error.h"
#include "tests/fuzz/fuzz_input.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using patrol::test::MemoryFile, patrol::test::require;
  try {
    const patrol::io::MovingAiMap map = patrol::io::load_moving_ai_map(MemoryFile(data, size).path());
    require(map.terrain.values().size() == map.terrain.geometry().size(), "each cell has its terrain");
    require(map.terrain.values().size() <= size, "a map is no larger than its file");
    patrol::io::to_occupancy(map, {0, 0});
  } catch (const patrol::InputError&) {}
  try {
    for (const patrol::io::MovingAiProblem& problem :
         patrol::io::load_moving_ai_problems(MemoryFile(data, size).path())) {
      const patrol::GridGeometry geometry{.resolution_m = 1.0, .width = problem.width, .height = problem.height};
      require(geometry.contains(problem.start) && geometry.contains(problem.goal), "both ends lie on the map");
      require(std::isfinite(problem.optimal_length) && problem.optimal_length >= 0.0, "lengths are figures");
    }
  } catch (const patrol::InputError&) {}
  return 0;
}
