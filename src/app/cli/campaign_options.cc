#include "app/cli/command_options.h"
#include "app/cli/number_checks.h"

namespace patrol::app {
namespace {

void add_batch(CLI::App& command, BatchOptions& batch) {
  command.add_option("--jobs", batch.jobs, "Parallel runs (0: one per core)")->capture_default_str();
  command.add_option("--run-timeout-s", batch.run_timeout_s, "Wall-clock timeout per run, s")->capture_default_str();
  command.add_option("--keep-runs", batch.keep_runs, "Run directories to keep: none, failed, all")
      ->capture_default_str();
}

/// Adds the options that sweep, error-budget and fault-matrix have in common. `metrics`: help text of --metric.
template <typename Options>
void add_variants(CLI::App& command, Options& options, const char* metrics) {
  add_scenario(command, options.scenario);
  command.add_option("--set", options.overrides, kSetAllHelp)->take_all();
  command.add_option("--seeds", options.seeds, "Seeds: N (1 ... N) or A..B")->capture_default_str();
  command.add_option("--metric", options.metrics, metrics)->take_all()->capture_default_str();
  add_batch(command, options.batch);
  command.add_option("--out", options.out, "Output directory; existing results are reused")->capture_default_str();
}

void add_sweep(CLI::App& app, Call& call) {
  SweepOptions& sweep = call.sweep;
  CLI::App* command = app.add_subcommand("sweep", "Run variants of a scenario and compare them");
  add_variants(*command, sweep, "Metric to compare (repeatable)");
  command
      ->add_option("--vary", sweep.vary,
                   "Parameter axis (repeatable): path=a,b,c or path=range:FROM:TO:N or logrange:..., one variant per "
                   "value; path=uniform:LOW:HIGH, loguniform:LOW:HIGH or normal:MEAN:STD, one sample per seed")
      ->take_all();
  command->add_flag("--early-stop", sweep.early_stop, "Stop a variant once its difference is significant");
  command->add_option("--equivalence-margin", sweep.equivalence_margin, "Differences below this are treated as equal")
      ->capture_default_str();
  command->add_option("--shard", sweep.shard, "Process shard i/n of the runs");
  command->add_option("--engine", sweep.engine, "Execution engine: local or slurm")->capture_default_str();
  command->add_option("--slurm-tasks", sweep.slurm_tasks, "Tasks of the Slurm job array, one shard each")
      ->capture_default_str();
  command
      ->add_option("--slurm-option", sweep.slurm_options,
                   "Option for sbatch (repeatable): --slurm-option=--partition=long")
      ->take_all();
  command->add_flag("--detach", sweep.detach, "Submit to Slurm without waiting");
  add_json(*command, sweep.form);
  command->callback([&] { call.chosen = [&] { return sweep_command(call.sweep); }; });
}

void add_merge(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("merge", "Merge the shards of a sweep");
  command->add_option("sweep", call.merge.root, "Directory of the sweep")->required();
  command->add_option("parts", call.merge.parts, "Directories of the shards");
  add_json(*command, call.merge.form);
  command->callback([&] { call.chosen = [&] { return merge_command(call.merge); }; });
}

void add_error_budget(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("error-budget", "Rerun with one error source removed at a time");
  command->alias("budget");
  add_variants(*command, call.error_budget, "Metric to analyze (repeatable)");
  add_json(*command, call.error_budget.form);
  command->callback([&] { call.chosen = [&] { return error_budget_command(call.error_budget); }; });
}

void add_fault_matrix(CLI::App& app, Call& call) {
  FaultMatrixOptions& faults = call.fault_matrix;
  CLI::App* command = app.add_subcommand("fault-matrix", "Inject every fault into every sensor");
  command->alias("faults");
  add_variants(*command, faults, "Metric to compare with the fault-free run (repeatable)");
  command->add_option("--fault", faults.faults, "Only this fault, e.g. 'lidar: dropout' (repeatable)")->take_all();
  command->add_option("--start-s", faults.start_s, "Fault onset, s")->check(not_negative())->capture_default_str();
  command->add_option("--duration-s", faults.duration_s, "Fault duration, s")
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("--max-error-m", faults.max_error_m, "Largest position error of a survived run, m")
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("--min-map-coverage", faults.min_map_coverage, "Smallest map coverage of a survived run")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--max-lost-s", faults.max_lost_s, "Longest time reported lost on a given map, s")
      ->check(not_negative())
      ->capture_default_str();
  add_json(*command, faults.form);
  command->callback([&] { call.chosen = [&] { return fault_matrix_command(call.fault_matrix); }; });
}

void add_study(CLI::App& app, Call& call) {
  StudyOptions& study = call.study;
  CLI::App* command = app.add_subcommand("study", "Reproduce a published experiment");
  command->add_option("name", study.name, "Name of the study (see 'patrol list')")->required();
  command->add_option("--seeds", study.seeds, "Seeds: N (the first N that are not used for tuning) or A..B");
  command->add_option("--jobs", study.jobs, "Parallel seeds (0: one per core)")->capture_default_str();
  command->add_option("--out", study.out, "Output directory; existing seeds are reused")->capture_default_str();
  add_json(*command, study.form);
  command->callback([&] { call.chosen = [&] { return study_command(call.study); }; });
}

void add_test(CLI::App& app, Call& call) {
  TestOptions& test = call.test;
  CLI::App* command = app.add_subcommand("test", "Run all scenarios of a folder; write JUnit XML");
  command->add_option("scenarios", test.scenarios, "Folders of scenarios, scenario files, worlds, and WORLD/SCENARIO")
      ->required();
  command->add_option("--set", test.overrides, kSetAllHelp)->take_all();
  CLI::Option* table =
      command->add_option("--seed-table", test.seed_table, "Seeds of scenarios (JSON: end of a scenario's path, seed)");
  CLI::Option* calibrate = command->add_option(
      "--calibrate", test.calibrate, "Propose expectations from seeds N (1 ... N) or A..B instead of testing");
  calibrate->excludes(table);
  command->add_flag("--write", test.write, "Write the proposed expectations to the scenarios")->needs(calibrate);
  command->add_flag("--widen", test.widen, "Allow proposals that are wider than the present ones")->needs(calibrate);
  add_batch(*command, test.batch);
  command->add_option("--out", test.out, "Output directory (default: out/test or out/calibration)");
  add_json(*command, test.form);
  command->callback([&] { call.chosen = [&] { return test_command(call.test); }; });
}

}  // namespace

void add_campaign_commands(CLI::App& app, Call& call) {
  add_sweep(app, call);
  add_merge(app, call);
  add_error_budget(app, call);
  add_fault_matrix(app, call);
  add_study(app, call);
  add_test(app, call);
}

}  // namespace patrol::app
