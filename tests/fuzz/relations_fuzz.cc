#include "io/trajectories/relations.h"

#include <cmath>

#include "core/error.h"
#include "tests/fuzz/fuzz_input.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using patrol::test::require;
  const patrol::test::MemoryFile file(data, size);
  try {
    for (const patrol::PoseRelation& relation : patrol::io::load_relations(file.path())) {
      require(std::isfinite(relation.T_from_to.x) && std::isfinite(relation.T_from_to.y), "positions are finite");
      require(std::abs(relation.T_from_to.yaw) <= 3.15, "headings are wrapped");
    }
  } catch (const patrol::InputError&) {}
  return 0;
}
