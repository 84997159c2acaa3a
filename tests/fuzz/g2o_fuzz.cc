#include "io/trajectories/g2o.h"

#include <optional>

#include "core/error.h"
#include "tests/fuzz/fuzz_input.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using patrol::test::MemoryFile, patrol::test::require;
  std::optional<patrol::PoseGraph> graph;
  try {
    graph = patrol::io::load_g2o(MemoryFile(data, size).path());
  } catch (const patrol::InputError&) {
    return 0;
  }
  for (const patrol::PoseGraphEdge& edge : graph->edges) {
    const auto num_nodes = static_cast<int>(graph->T_map_node.size());
    require(edge.from >= 0 && edge.to >= 0 && edge.from < num_nodes && edge.to < num_nodes, "edges lie between nodes");
  }
  const std::string text = patrol::io::to_g2o(*graph);
  require(patrol::io::to_g2o(patrol::io::load_g2o(MemoryFile(text).path())) == text,
          "what was read can be written and read again");
  return 0;
}
