#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/campaign/batch/batch_options.h"
#include "app/campaign/batch/process_pool.h"
#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "app/common/print_result.h"
#include "app/common/progress_bar.h"
#include "app/scenario/run_hash.h"
#include "app/study/study_table.h"
#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/csv.h"
#include "io/json/metrics_json.h"
#include "io/json/table_json.h"
#include "report/page.h"
#include "studies/study_results.h"

namespace patrol::app {
namespace {

const OutputKind kStudy = {
    .name = "study",
    .marker_text = "Not all seeds have run; the tables follow at the end. Rerun the same command to continue.",
    .outputs = {"results.csv", "runs.csv", "performance.csv", "report.html"},
    .required_file = "study.json",
    .preserved = {"study.json", "seeds", "*.part"}};

/// Parses seeds. "N": the first N after those used for tuning; or "A..B".
std::vector<std::uint64_t> evaluation_seeds(const std::string& text) {
  constexpr std::uint64_t kTuned = 1000;
  std::vector<std::uint64_t> seeds = parse_seeds(text);
  if (text.find("..") == std::string::npos) {
    for (std::uint64_t& seed : seeds) seed += kTuned;
  }
  return seeds;
}

/// Samples by seed, one file each, written atomically; those of another study or build are ignored.
class SampleStore {
 public:
  SampleStore(std::filesystem::path folder, const studies::Study& study)
      : folder_(std::move(folder)), study_(study), build_(build_id()) {
    std::filesystem::create_directories(folder_);
  }

  std::optional<studies::StudySample> load(std::uint64_t seed) const {
    if (!std::filesystem::exists(file(seed))) return std::nullopt;
    const io::Metrics json = io::load_metrics(file(seed));
    if (json.value("study", "") != study_.name || json.value("build", "") != build_ || !json.contains("figures"))
      return std::nullopt;
    studies::StudySample sample;
    for (const io::Metrics& variant : json["figures"]) {
      std::vector<double>& metrics = sample.emplace_back();
      for (const io::Metrics& metric : variant)
        metrics.push_back(metric.is_number() ? metric.get<double>() : std::numeric_limits<double>::quiet_NaN());
    }
    return sample;
  }

  void save(std::uint64_t seed, const studies::StudySample& sample) const {
    io::save_metrics(file(seed), {{"study", study_.name}, {"build", build_}, {"figures", sample}});
  }

 private:
  std::filesystem::path file(std::uint64_t seed) const { return folder_ / fmt::format("{}.json", seed); }

  std::filesystem::path folder_;
  const studies::Study& study_;
  std::string build_;
};

/// Runs the missing seeds; false if interrupted.
bool run_seeds(const studies::Study& study, const std::vector<std::uint64_t>& seeds, const SampleStore& store,
               const ProcessPoolSettings& pool) {
  std::vector<std::uint64_t> missing;
  for (const std::uint64_t seed : seeds) {
    if (!store.load(seed)) missing.push_back(seed);
  }
  InterruptGuard guard;
  ProgressBar bar;
  const std::size_t num_reused = seeds.size() - missing.size();
  std::size_t num_done = num_reused;
  const auto task = [&](std::size_t i) {
    store.save(missing[i], study.run(missing[i]));
    return 0;
  };
  const auto on_end = [&](const TaskEnd& end) {
    if (end.exit_code != 0 || end.signal != 0) {
      throw std::runtime_error(
          fmt::format("study {}: seed {} failed: {}", study.name, missing[end.task], end.last_stderr_line));
    }
    ++num_done;
    bar.show(fmt::format("study {}: {} of {} seeds", study.name, num_done, seeds.size()),
             static_cast<double>(num_done - num_reused) / static_cast<double>(missing.size()));
  };
  return run_in_processes(missing.size(), pool, task, on_end, [&] { return !guard.is_interrupted(); });
}

}  // namespace

ExitCode study_command(const StudyOptions& options) {
  const studies::Study study = make_study(options.name);
  const std::vector<std::uint64_t> seeds =
      evaluation_seeds(options.seeds.value_or(std::to_string(study.default_seeds)));
  const BatchSettings settings =
      batch_settings({.jobs = options.jobs, .run_timeout_s = options.seed_timeout_s, .keep_runs = "none"});

  const OutputLock lock = begin_output(options.out, kStudy);
  io::save_metrics(options.out / "study.json", {{"study", study.name}, {"seeds", seeds}});
  const SampleStore store(options.out / "seeds", study);
  if (!run_seeds(study, seeds, store, settings.pool))
    throw std::runtime_error(
        fmt::format("interrupted; {} is incomplete; rerun the same command to continue", options.out.string()));

  std::vector<studies::StudySample> samples;
  for (const std::uint64_t seed : seeds) samples.push_back(store.load(seed).value());
  const studies::StudyResults results = studies::summarize(study, samples);
  for (const io::Table& table : {studies::results_table(study, results), studies::samples_table(study, seeds, samples),
                                 studies::performance_table(study, results)}) {
    io::save_csv(options.out / (table.name + ".csv"), table);
  }
  io::save_text(options.out / "report.html", report::to_html(studies::study_page(study, seeds, samples, results)));
  complete_output(options.out);
  print_result(options.form,
               fmt::format("{}\nsource: {}\n{}\n\n{}{}\n", study.title, study.source, study.conditions,
                           studies::results_text(study, results), (options.out / "report.html").string()),
               {{"study", study.name},
                {"source", study.source},
                {"seeds", seeds},
                {"results", to_json(studies::results_table(study, results))}});
  return ExitCode::kDone;
}

}  // namespace patrol::app
