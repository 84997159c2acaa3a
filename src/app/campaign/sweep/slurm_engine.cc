#include "app/campaign/sweep/slurm_engine.h"

#include <chrono>
#include <set>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "app/campaign/batch/program.h"
#include "app/campaign/sweep/comparison.h"
#include "app/campaign/sweep/finish_sweep.h"
#include "app/common/progress_bar.h"
#include "core/text.h"
#include "io/files/atomic_file.h"

namespace patrol::app {
namespace {

constexpr int kMaxSubmissions = 3;
constexpr int kMaxQueries = 10;
constexpr std::chrono::seconds kPoll{2};

class SlurmJob {
 public:
  explicit SlurmJob(const std::filesystem::path& root) : folder_(root / "slurm") {
    std::filesystem::create_directories(folder_);
    if (std::filesystem::exists(id_file())) id_ = io::load_text(id_file());
  }

  /// Whether tasks of the job are waiting, running or just ending.
  bool is_in_queue() const {
    if (id_.empty()) return false;
    // Asked for one job, squeue fails both when that job ended long ago and when the controller does not answer; asked
    // for all jobs, it fails only in the second case.
    for (int attempt = 0; attempt < kMaxQueries; ++attempt) {
      if (attempt > 0) std::this_thread::sleep_for(kPoll);
      const ProgramResult queue = run_program({"squeue", "--noheader", "--me", "--format=%F"});
      if (queue.exit_code != 0) continue;
      return ("\n" + queue.output).find("\n" + id_ + "\n") != std::string::npos;
    }
    throw std::runtime_error(
        fmt::format("squeue failed {} times; repeat the command to wait for job {}", kMaxQueries, id_));
  }

  void submit(const SweepOptions& options, const std::string& shards) {
    const std::string command = shard_command(options, std::filesystem::read_symlink("/proc/self/exe"),
                                              fmt::format("\"$SLURM_ARRAY_TASK_ID\"/{}", options.slurm_tasks));
    io::save_text(script(), fmt::format("#!/bin/sh\n#SBATCH --job-name=patrol-sweep\nexec {}\n", command));
    std::vector<std::string> words = {"sbatch",
                                      "--parsable",
                                      "--array=" + shards,
                                      fmt::format("--cpus-per-task={}", std::max(1, options.batch.jobs)),
                                      fmt::format("--output={}", (folder_ / "%A_%a.txt").string()),
                                      "--open-mode=append"};
    words.insert(words.end(), options.slurm_options.begin(), options.slurm_options.end());
    words.push_back(script().string());
    const ProgramResult submitted = run_program(words);
    if (submitted.exit_code != 0)
      throw std::runtime_error(fmt::format("sbatch failed with exit status {}", submitted.exit_code));
    id_ = submitted.output.substr(0, submitted.output.find_first_of(";\n"));  // "123" or "123;cluster"
    io::save_text(id_file(), id_);
  }

  const std::string& id() const { return id_; }

 private:
  std::filesystem::path id_file() const { return folder_ / "job"; }
  std::filesystem::path script() const { return folder_ / "shard.sh"; }

  std::filesystem::path folder_;
  std::string id_;
};

}  // namespace

std::string shard_command(const SweepOptions& options, const std::filesystem::path& program, const std::string& shard) {
  std::string command = fmt::format(
      "{} sweep {} --seeds {} --jobs {} --keep-runs {} --run-timeout-s {} --out {} --shard {}",
      quote_for_shell(program.string()), quote_for_shell(std::filesystem::absolute(options.scenario).string()),
      quote_for_shell(options.seeds), std::max(1, options.batch.jobs), options.batch.keep_runs,
      options.batch.run_timeout_s, quote_for_shell(std::filesystem::absolute(options.out).string()), shard);
  const auto add = [&command](const char* option, const std::vector<std::string>& values) {
    for (const std::string& value : values) command += fmt::format(" {} {}", option, quote_for_shell(value));
  };
  add("--set", options.overrides);
  add("--vary", options.vary);
  add("--metric", options.metrics);
  return command;
}

std::string shards_with_work(const std::vector<std::size_t>& needed, int num_shards) {
  std::set<std::size_t> shards;
  for (const std::size_t run : needed) shards.insert(run % static_cast<std::size_t>(num_shards) + 1);
  std::vector<std::string> texts;
  for (const std::size_t shard : shards) texts.push_back(std::to_string(shard));
  return join(texts, ",");
}

ExitCode sweep_on_slurm(const SweepOptions& options, const SweepDirectory& directory, const SweepManifest& manifest) {
  SlurmJob job(directory.root);
  ProgressBar bar;
  const InterruptGuard interrupt;
  for (int submissions = 0; true;) {
    const auto needed = [&] { return evaluate_progress(manifest, load_rows(manifest, directory.store())).needed; };
    while (job.is_in_queue()) {
      if (options.detach || interrupt.is_interrupted()) {
        fmt::print("{}: job {} is running; repeat the command to wait for it\n", directory.root.string(), job.id());
        return interrupt.is_interrupted() ? ExitCode::kProgramFailed : ExitCode::kDone;
      }
      bar.show(fmt::format("job {}: {} of {} runs missing", job.id(), needed().size(), manifest.runs.size()));
      std::this_thread::sleep_for(kPoll);
    }
    const std::vector<std::size_t> missing = needed();
    if (missing.empty()) return finish_sweep(directory, manifest, options.form);
    if (submissions == kMaxSubmissions) {
      throw std::runtime_error(fmt::format("{}: {} runs are missing after {} submissions; see slurm/ for task logs",
                                           directory.root.string(), missing.size(), submissions));
    }
    job.submit(options, shards_with_work(missing, options.slurm_tasks));
    bar.print_line(fmt::format("job {}: {} runs in shards {}", job.id(), missing.size(),
                               shards_with_work(missing, options.slurm_tasks)));
    ++submissions;
  }
}

}  // namespace patrol::app
