#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/plan/plan_settings.h"
#include "io/moving_ai.h"

namespace patrol::app {

/// Tolerance on a published optimum beside the rounding of its digits, cells.
inline constexpr double kPublishedTol = 1e-4;

/// What a planner made of one problem of a .scen file.
struct SolvedProblem {
  io::MovingAiProblem problem;
  plan::PlanStatus status = plan::PlanStatus::kNoRoute;
  double length = 0.0;  ///< cells
  int num_turns = 0;
  std::int64_t num_expanded = 0;
  double processor_s = 0.0;
  std::optional<std::string> failure = {};  ///< which check fails, as a sentence

  bool is_found() const { return status == plan::PlanStatus::kFound; }
  /// Largest difference of the length from the published one that its digits allow, cells.
  double published_tol() const { return kPublishedTol + problem.length_rounding; }
  bool agrees() const { return is_found() && std::abs(length - problem.optimal_length) <= published_tol(); }
  /// To the published optimum; none where that is 0.
  std::optional<double> ratio() const {
    return is_found() && problem.optimal_length > 0.0 ? std::optional(length / problem.optimal_length) : std::nullopt;
  }
};

/// Whether the planner's lengths must be the published ones: those of the shortest ways over eight neighbours.
bool must_agree(const std::string& planner);

/// The map that a problem names: relative to the file, else the name's last part beside it. Throws InputError when there is neither.
std::filesystem::path find_map(const std::filesystem::path& file, const io::MovingAiProblem& problem);

/// Every problem of the file by one planner, each route checked (app/plan/route_check.h): it must be found; A*'s and Dijkstra's must have the
/// published length, those of Theta* and of the any-angle optimum must not be longer. With a line on a terminal; none when interrupted. Throws
/// InputError with the file and the line.
std::optional<std::vector<SolvedProblem>> solve_problems(const std::filesystem::path& file, const PlanSettings& settings);

}  // namespace patrol::app
