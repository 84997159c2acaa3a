#include "app/plan/problem_output.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/plan/route_output.h"
#include "score/statistics.h"

namespace patrol::app {
namespace {

constexpr std::size_t kMaxFailuresPrinted = 20;

struct Summary {
  std::size_t num_found = 0, num_agree = 0;
  double worst_difference = 0.0;  ///< difference from the published length, cells
  std::vector<double> ratios;
  double processor_s = 0.0;
};

Summary to_summary(const ProblemReport& report) {
  Summary summary;
  for (const SolvedProblem& solved : report.solved) {
    summary.processor_s += solved.processor_s;
    if (!solved.is_found()) continue;
    ++summary.num_found;
    if (solved.agrees()) ++summary.num_agree;
    summary.worst_difference =
        std::max(summary.worst_difference, std::abs(solved.length - solved.problem.optimal_length));
    if (solved.ratio()) summary.ratios.push_back(*solved.ratio());
  }
  return summary;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? std::nan("") : sum / static_cast<double>(values.size());
}

}  // namespace

std::size_t num_failed(const ProblemReport& report) {
  const auto has_failed = [](const SolvedProblem& solved) { return solved.failure.has_value(); };
  return static_cast<std::size_t>(std::count_if(report.solved.begin(), report.solved.end(), has_failed));
}

std::string to_text(const ProblemReport& report) {
  const Summary summary = to_summary(report);
  const std::size_t count = report.solved.size(), failed = num_failed(report);
  std::string text =
      fmt::format("{}: {} problems by {}\nroutes             {} found, each checked against every lethal cell\n",
                  report.file_name, count, report.settings.planner, summary.num_found);
  text +=
      fmt::format("published lengths  {} agree to the last digit{}, worst difference {:.3g} cells\n", summary.num_agree,
                  must_agree(report.settings.planner) ? "" : " (not expected)", summary.worst_difference);
  if (!summary.ratios.empty()) {
    text += fmt::format("length / optimum   mean {:.6f}, median {:.6f}, minimum {:.6f}, maximum {:.6f}\n",
                        mean_of(summary.ratios), score::percentile(summary.ratios, 0.5),
                        *std::min_element(summary.ratios.begin(), summary.ratios.end()),
                        *std::max_element(summary.ratios.begin(), summary.ratios.end()));
  }
  text += fmt::format("processor time     {:.3f} ms per problem, {:.2f} s in total\nchecks failed      {}\n",
                      1e3 * summary.processor_s / static_cast<double>(count), summary.processor_s, failed);
  std::size_t num_printed = 0;
  for (const SolvedProblem& solved : report.solved) {
    if (solved.failure && num_printed++ < kMaxFailuresPrinted)
      text += fmt::format("  {}:{}: {}\n", report.file_name, solved.problem.line, *solved.failure);
  }
  if (failed > kMaxFailuresPrinted) text += fmt::format("  and {} more\n", failed - kMaxFailuresPrinted);
  return text;
}

io::Metrics to_json(const ProblemReport& report) {
  const Summary summary = to_summary(report);
  const auto ratio = [&](double value) { return summary.ratios.empty() ? std::nan("") : value; };
  const std::vector<double>& ratios = summary.ratios;
  return {{"problems", report.file_name},
          {"planner", report.settings.planner},
          {"seed", report.settings.seed},
          {"num_problems", report.solved.size()},
          {"num_found", summary.num_found},
          {"num_agree", summary.num_agree},
          {"num_failed", num_failed(report)},
          {"worst_difference_cells", summary.worst_difference},
          {"ratio",
           {{"mean", mean_of(ratios)},
            {"median", ratios.empty() ? std::nan("") : score::percentile(ratios, 0.5)},
            {"least", ratio(ratios.empty() ? 0.0 : *std::min_element(ratios.begin(), ratios.end()))},
            {"worst", ratio(ratios.empty() ? 0.0 : *std::max_element(ratios.begin(), ratios.end()))}}},
          {"performance",
           {{"processor_s", summary.processor_s},
            {"processor_s_per_problem", summary.processor_s / static_cast<double>(report.solved.size())}}}};
}

io::Table problem_table(const ProblemReport& report) {
  io::Table table{.name = "problems",
                  .columns = {"line", "bucket", "start_x", "start_y", "goal_x", "goal_y", "published_cells", "status",
                              "length_cells", "ratio", "turns", "expanded_cells", "failure"},
                  .rows = {}};
  for (const SolvedProblem& solved : report.solved) {
    const io::MovingAiProblem& problem = solved.problem;
    const auto whole = [](std::int64_t value) { return io::TableValue(value); };
    const auto from_top = [&](Cell cell) { return whole(problem.height - 1 - cell.row); };
    table.rows.push_back({whole(problem.line), whole(problem.bucket), whole(problem.start.col), from_top(problem.start),
                          whole(problem.goal.col), from_top(problem.goal), problem.optimal_length,
                          std::string(status_name(solved.status)),
                          solved.is_found() ? io::TableValue(solved.length) : io::TableValue(),
                          solved.ratio() ? io::TableValue(*solved.ratio()) : io::TableValue(), whole(solved.num_turns),
                          whole(solved.num_expanded), solved.failure.value_or("")});
  }
  return table;
}

}  // namespace patrol::app
