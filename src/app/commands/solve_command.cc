#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "core/error.h"
#include "io/trajectories/g2o.h"
#include "slam/graph/connections.h"
#include "slam/graph/pose_graph_solver.h"

namespace patrol::app {

namespace {

/// Warns of nodes whose poses the edges do not determine.
void warn_of_parts(const PoseGraph& graph, const std::string& file) {
  if (graph.edges.empty()) {
    fmt::print(stderr, "patrol: {}: has no edges: the poses stay as they are\n", file);
    return;
  }
  slam::Connections connections(graph.T_map_node.size());
  for (const PoseGraphEdge& edge : graph.edges)
    connections.connect(static_cast<std::size_t>(edge.from), static_cast<std::size_t>(edge.to));
  if (connections.num_parts() > 1)
    fmt::print(stderr,
               "patrol: {}: {} parts that no edge connects: their poses relative to each other are not solved\n", file,
               connections.num_parts());
}

}  // namespace

ExitCode solve_command(const SolveOptions& options) {
  if (std::filesystem::exists(options.out) && std::filesystem::equivalent(options.graph, options.out)) {
    throw InputError(options.out.string() + ": is the input graph: must be another file");
  }
  PoseGraph graph = io::load_g2o(options.graph);
  warn_of_parts(graph, options.graph.string());
  slam::PoseGraphSolverSettings settings{.max_iterations = 200};
  settings.robust_loop_closures = options.robust_loop_closures;
  const slam::PoseGraphSolution solution = slam::solve(graph, settings);
  std::error_code ignored;  // save_g2o reports a folder that cannot be made
  if (options.out.has_parent_path()) std::filesystem::create_directories(options.out.parent_path(), ignored);
  io::save_g2o(options.out, graph);
  fmt::print("{} nodes, {} edges{}\nsum of squared errors {:.2f} -> {:.2f} in {} iterations{}\n{}\n",
             graph.T_map_node.size(), graph.edges.size(),
             options.robust_loop_closures ? ", robust loss on loop closures" : "", 2.0 * solution.initial_cost,
             2.0 * solution.final_cost, solution.iterations, solution.converged ? "" : ", not converged",
             options.out.string());
  return solution.converged ? ExitCode::kDone : ExitCode::kExpectationMissed;
}

}  // namespace patrol::app
