#include "io/trajectories/tum.h"

#include <cmath>

#include "core/error.h"
#include "tests/fuzz/fuzz_input.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using patrol::test::require;
  const patrol::test::MemoryFile file(data, size);
  for (const auto same_stamps : {patrol::io::SameStamps::kRefuse, patrol::io::SameStamps::kKeepFirst}) {
    try {
      const patrol::Trajectory trajectory = patrol::io::load_tum(file.path(), same_stamps);
      for (std::size_t i = 0; i < trajectory.size(); ++i) {
        require(trajectory[i].pose.position.allFinite() && std::abs(trajectory[i].pose.rotation.norm() - 1.0) < 1e-9,
                "poses are poses");
        require(i == 0 || trajectory[i - 1].stamp < trajectory[i].stamp, "stamps grow");
      }
    } catch (const patrol::InputError&) {}
  }
  return 0;
}
