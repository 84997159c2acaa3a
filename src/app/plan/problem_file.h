#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/plan/plan_settings.h"
#include "io/maps/moving_ai.h"

namespace patrol::app {

/// Tolerance of a published optimum in addition to the rounding of its digits, cells.
inline constexpr double kPublishedTolerance = 1e-4;

/// Result of a planner for one problem of a .scen file.
struct SolvedProblem {
  io::MovingAiProblem problem;
  plan::PlanStatus status = plan::PlanStatus::kNoRoute;
  double length = 0.0;  ///< cells
  int num_turns = 0;
  std::int64_t num_expanded = 0;
  double processor_s = 0.0;
  std::optional<std::string> failure = {};  ///< sentence on the check that failed

  bool is_found() const { return status == plan::PlanStatus::kFound; }
  /// Maximum difference from the published length that its digits allow, cells.
  double published_tolerance() const { return kPublishedTolerance + problem.length_rounding; }
  bool agrees() const { return is_found() && std::abs(length - problem.optimal_length) <= published_tolerance(); }
  /// Ratio to the published optimum; none if that is 0.
  std::optional<double> ratio() const {
    return is_found() && problem.optimal_length > 0.0 ? std::optional(length / problem.optimal_length) : std::nullopt;
  }
};

/// Whether the planner's lengths must equal the published ones: shortest paths over eight neighbors.
bool must_agree(const std::string& planner);

/// Path of the map that a problem names: relative to the file, otherwise the file name alone in the same folder. Throws
/// InputError if neither exists.
std::filesystem::path find_map(const std::filesystem::path& file, const io::MovingAiProblem& problem);

/// Solves every problem of the file by one planner and checks each route (app/plan/route_check.h). A route must be
/// found; the lengths of A* and Dijkstra must equal the published ones, those of Theta* and of the any-angle optimum
/// must not exceed them. Shows progress in a terminal; none if interrupted. Throws InputError with the file and the
/// line.
std::optional<std::vector<SolvedProblem>> solve_problems(const std::filesystem::path& file,
                                                         const PlanSettings& settings);

}  // namespace patrol::app
