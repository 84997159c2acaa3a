#include <fmt/format.h>

#include "app/commands/commands.h"
#include "core/error.h"
#include "io/trajectories/g2o.h"
#include "slam/graph/pose_graph_solver.h"

namespace patrol::app {

ExitCode solve_command(const SolveOptions& options) {
  if (std::filesystem::exists(options.out) && std::filesystem::equivalent(options.graph, options.out)) {
    throw InputError(options.out.string() + ": is the input graph: must be another file");
  }
  PoseGraph graph = io::load_g2o(options.graph);
  slam::PoseGraphSolverSettings settings{.max_iterations = 200};
  settings.robust_loop_closures = options.robust_loop_closures;
  const slam::PoseGraphSolution solution = slam::solve(graph, settings);
  io::save_g2o(options.out, graph);
  fmt::print("{} nodes, {} edges{}\nsum of squared errors {:.2f} -> {:.2f} in {} iterations{}\n{}\n",
             graph.T_map_node.size(), graph.edges.size(),
             options.robust_loop_closures ? ", robust loss on loop closures" : "", 2.0 * solution.initial_cost,
             2.0 * solution.final_cost, solution.iterations, solution.converged ? "" : ", not converged",
             options.out.string());
  return solution.converged ? ExitCode::kDone : ExitCode::kExpectationMissed;
}

}  // namespace patrol::app
