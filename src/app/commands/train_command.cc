#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/print_result.h"
#include "app/common/progress_bar.h"
#include "app/mapping/submap_track.h"
#include "io/json/adaboost_json.h"
#include "io/yaml/settings_yaml.h"
#include "slam/submaps/neighbor_examples.h"
#include "slam/submaps/pair_features.h"

namespace patrol::app {
namespace {

/// Settings of `patrol train-neighbors --set`.
struct TrainingSettings {
  std::uint64_t seed = 1;
  slam::PlanarScanSettings scan;
  slam::SubmapRbpfSettings submap_rbpf;
  slam::NeighborExampleSettings examples;
  slam::AdaBoostSettings boosting;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("seed", self.seed);
    visit("scan", self.scan);
    visit("submap_rbpf", self.submap_rbpf);
    visit("examples", self.examples);
    visit("boosting", self.boosting);
  }
};

/// Labeled pairs of submaps from the runs; none if interrupted.
std::optional<slam::LabeledFeatures> examples_of(const std::vector<std::filesystem::path>& runs,
                                                 const TrainingSettings& settings, const InterruptGuard& guard) {
  slam::SubmapRbpfSettings apart = settings.submap_rbpf;
  apart.max_candidates = 0;  // no submap constraints: the classifier does not exist yet
  slam::LabeledFeatures examples{.names = slam::pair_feature_names(), .examples = {}, .labels = {}};
  ProgressBar bar;
  for (const std::filesystem::path& run : runs) {
    const std::optional<SubmapTrack> track = build_submaps(run, settings.scan, apart, {}, settings.seed, bar, guard);
    if (!track) return std::nullopt;
    const std::size_t before = examples.labels.size();
    slam::add_neighbor_examples(track->slam, track->T_world_submap, settings.submap_rbpf.surfaces, settings.examples,
                                settings.seed + before, examples);
    const auto joinable =
        std::count(examples.labels.begin() + static_cast<std::ptrdiff_t>(before), examples.labels.end(), 1);
    bar.print_line(fmt::format("{}: {} submaps, {} examples, {} of them neighbors", run.string(),
                               track->T_world_submap.size(), examples.labels.size() - before, joinable));
  }
  return examples;
}

struct Recognized {
  double precision = 0.0, recall = 0.0;
};

Recognized recognized_at(double min_margin, const BoostedStumps& model, const slam::LabeledFeatures& examples) {
  int right = 0, wrong = 0, missed = 0;
  for (std::size_t i = 0; i < examples.labels.size(); ++i) {
    const bool is_taken = model.margin(examples.examples[i]) > min_margin, is_neighbor = examples.labels[i] > 0;
    right += is_taken && is_neighbor ? 1 : 0;
    wrong += is_taken && !is_neighbor ? 1 : 0;
    missed += !is_taken && is_neighbor ? 1 : 0;
  }
  const auto ratio = [](int part, int rest) {
    return part + rest > 0 ? static_cast<double>(part) / (part + rest) : 1.0;
  };
  return {.precision = ratio(right, wrong), .recall = ratio(right, missed)};
}

/// Precision and recall of the model on a set of examples, by minimum margin.
io::Table recognition_table(const BoostedStumps& model, const slam::LabeledFeatures& examples) {
  io::Table table{.name = "recognition", .columns = {"min_margin", "precision", "recall"}, .rows = {}};
  for (const double margin : {0.0, 0.1, 0.2, 0.3, 0.4}) {
    const Recognized recognized = recognized_at(margin, model, examples);
    table.rows.push_back({margin, recognized.precision, recognized.recall});
  }
  return table;
}

std::string to_text(const char* of, std::size_t num_examples, const io::Table& recognition) {
  std::string text = fmt::format("{}, {} examples:\n  margin above   precision   recall\n", of, num_examples);
  for (const auto& row : recognition.rows)
    text += fmt::format("  {:12.1f}   {:9.4f}   {:6.4f}\n", std::get<double>(row[0]), std::get<double>(row[1]),
                        std::get<double>(row[2]));
  return text;
}

}  // namespace

ExitCode train_command(const TrainOptions& options) {
  const auto settings = io::parse_settings<TrainingSettings>(options.overrides);
  const InterruptGuard guard;
  const std::optional<slam::LabeledFeatures> training = examples_of(options.runs, settings, guard);
  const std::optional<slam::LabeledFeatures> held_out =
      training ? examples_of(options.validation, settings, guard) : std::nullopt;
  if (!training || !held_out) {
    fmt::print(stderr, "patrol: interrupted; nothing written\n");
    return ExitCode::kProgramFailed;
  }
  const slam::BoostingResult boosted = slam::train_adaboost(*training, settings.boosting);
  io::save_boosted_stumps(options.out, boosted.model);
  std::string text = fmt::format("{} stumps; training error {:.2f} %, bound {:.2f} %\n", boosted.model.stumps.size(),
                                 100.0 * boosted.training_error, 100.0 * std::min(1.0, boosted.error_bound));
  io::Metrics json{{"stumps", boosted.model.stumps.size()},
                   {"training_error", boosted.training_error},
                   {"training_error_bound", boosted.error_bound},
                   {"model", options.out.string()}};
  for (const auto& [name, examples] : {std::pair("training", &*training), std::pair("validation", &*held_out)}) {
    if (examples->labels.empty()) continue;
    const io::Table recognition = recognition_table(boosted.model, *examples);
    text += to_text(name, examples->labels.size(), recognition);
    json[name] = {{"examples", examples->labels.size()}, {"recognition", to_json(recognition)}};
  }
  print_result(options.form, text + options.out.string() + "\n", json);
  return ExitCode::kDone;
}

}  // namespace patrol::app
