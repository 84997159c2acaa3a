#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/plan/plan_settings.h"
#include "app/plan/problem_file.h"
#include "io/files/table.h"
#include "io/json/metrics_json.h"

namespace patrol::app {

struct ProblemReport {
  std::string file_name;
  const PlanSettings& settings;
  const std::vector<SolvedProblem>& solved;
};

std::size_t num_failed(const ProblemReport& report);

/// Report for standard output, failures by line.
std::string to_text(const ProblemReport& report);
/// Report as JSON, with times under `performance`.
io::Metrics to_json(const ProblemReport& report);
/// Table with one row per problem, cells in the coordinates of the file.
io::Table problem_table(const ProblemReport& report);

}  // namespace patrol::app
