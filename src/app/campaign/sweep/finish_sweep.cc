#include "app/campaign/sweep/finish_sweep.h"

#include <fmt/format.h>

#include "app/campaign/sweep/budget.h"
#include "app/campaign/sweep/comparison.h"
#include "app/campaign/sweep/fault_tables.h"
#include "app/campaign/sweep/sweep_tables.h"
#include "io/files/atomic_file.h"
#include "io/json/table_json.h"

namespace patrol::app {
namespace {

/// Results of a sweep, for files and for the terminal.
struct Findings {
  std::vector<io::Table> tables;
  std::string text;
  std::string markdown;  ///< Markdown text for documents; empty if there is no such form
};

Findings findings_of(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress) {
  Findings findings{.tables = {runs_table(manifest, rows, progress), comparison_table(manifest, rows, progress)},
                    .text = "",
                    .markdown = ""};
  switch (manifest.kind) {
    case SweepKind::kSweep:
      findings.text = comparison_text(manifest, rows, progress);
      break;
    case SweepKind::kBudget: {
      const std::vector<Budget> budgets = make_budgets(manifest, rows);
      findings.tables.push_back(budget_table(budgets));
      for (const Budget& budget : budgets) findings.text += budget_text(budget) + "\n";
      break;
    }
    case SweepKind::kFaults:
      findings.tables.push_back(faults_table(manifest, rows));
      findings.text = faults_text(manifest, rows);
      findings.markdown = faults_markdown(manifest, rows);
      break;
  }
  return findings;
}

/// Exit code of the worst counted run; kNothingExecuted without runs.
ExitCode worst_of(const SweepRows& rows, const SweepProgress& progress) {
  if (progress.counted.empty()) return ExitCode::kNothingExecuted;
  ExitCode worst = ExitCode::kDone;
  for (const std::size_t i : progress.counted) worst = worse(worst, rows[i]->code());
  return worst;
}

/// Exit code of the worst run of a shard that gave no result; kDone if there is none.
ExitCode worst_failure_of(const SweepRows& rows, const Shard& shard) {
  ExitCode worst = ExitCode::kDone;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!shard.contains(i) || !rows[i]) continue;
    const ExitCode code = rows[i]->code();
    if (code == ExitCode::kProgramFailed || code == ExitCode::kWrongInput) worst = worse(worst, code);
  }
  return worst;
}

}  // namespace

ExitCode finish_sweep(const SweepDirectory& directory, const SweepManifest& manifest, ResultForm form,
                      const Shard& shard) {
  const SweepRows rows = load_rows(manifest, directory.store());
  const SweepProgress progress = evaluate_progress(manifest, rows);
  io::Metrics json{{"directory", directory.root.string()},
                   {"runs", progress.counted.size()},
                   {"missing_runs", progress.needed.size()}};
  if (!progress.needed.empty()) {
    print_result(form,
                 fmt::format("{}: {} of {} runs are missing; merge shards with 'patrol merge'\n",
                             directory.root.string(), progress.needed.size(), progress.counted.size()),
                 json);
    return worst_failure_of(rows, shard);
  }
  const Findings findings = findings_of(manifest, rows, progress);
  if (!findings.markdown.empty()) io::save_text(directory.root / "faults.md", findings.markdown);
  complete_sweep_directory(directory, findings.tables);
  for (const io::Table& table : findings.tables) json["tables"][table.name] = io::to_json(table);
  print_result(form,
               fmt::format("{}{} runs: {}\n", findings.text, progress.counted.size(),
                           directory.table(findings.tables.back().name).string()),
               json);
  return worst_of(rows, progress);
}

}  // namespace patrol::app
