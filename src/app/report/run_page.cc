#include "app/report/run_page.h"

#include <cstdint>

#include <fmt/format.h>

#include "app/report/error_plots.h"
#include "app/report/metric_blocks.h"
#include "app/report/event_timeline.h"
#include "app/report/run_map.h"
#include "app/report/settings_difference.h"
#include "app/report/verdict.h"
#include "io/files/atomic_file.h"

namespace patrol::app {
namespace {

constexpr std::uintmax_t kMaxEmbedded_bytes = 6u << 20;  // bytes: limit of common mail gateways

using Blocks = std::vector<report::Block>;

Blocks key_metric_blocks(const RunContents& run) {
  if (run.metrics.empty()) return {};
  return {key_metrics(run.metrics), all_metrics(run.metrics, check_expectations(run.scenario.expect, run.metrics))};
}

Blocks settings_blocks(const RunContents& run) {
  const Scenario standard = default_scenario(run.scenario.robot, find_data_root(run.directory.scenario()));
  report::TableBlock table{.caption = "", .columns = {{"setting"}, {"default"}, {"this run"}}, .rows = {}};
  for (const SettingDifference& difference : settings_differences(standard, run.scenario)) {
    table.rows.push_back({{difference.path}, {difference.standard, report::Tone::kFaint}, {difference.value}});
  }
  if (table.rows.empty()) return {report::TextBlock{"Every setting is the default."}};
  return {table, report::TextBlock{fmt::format("Defaults: the program's, under those of models/{0}/{0}.yaml. scenario.yaml lists every setting.", run.scenario.robot)}};
}

Blocks replay_blocks(const RunContents& run, const std::filesystem::path& page_file) {
  const std::filesystem::path video = run.directory.root / "replay.mp4";
  if (!std::filesystem::exists(video)) return {};
  if (std::filesystem::file_size(video) <= kMaxEmbedded_bytes) {
    return {report::VideoBlock{.mp4 = io::load_text(video), .url = "", .caption = "Rendered from the log by patrol replay"}};
  }
  const bool is_beside = std::filesystem::absolute(page_file).lexically_normal().parent_path() ==
                         std::filesystem::absolute(video).lexically_normal().parent_path();
  if (!is_beside) return {};
  return {report::VideoBlock{.mp4 = "", .url = "replay.mp4",
                             .caption = "Rendered from the log by patrol replay. Plays from replay.mp4, which must stay next to this page."}};
}

std::vector<std::pair<std::string, std::string>> facts_of(const RunContents& run) {
  return {{"world", run.scenario.world},
          {"robot", run.scenario.robot},
          {"mission", run.scenario.mission},
          {"seed", fmt::format("{}", run.scenario.seed)},
          {"simulated", fmt::format("{:.1f} s", run.end_s())},
          {"patrol", run.version.empty() ? "not known" : run.version}};
}

}  // namespace

report::Page run_page(const RunContents& run, const std::filesystem::path& page_file) {
  report::Page page{.kind = "report of a run",
                    .title = fmt::format("{} in the {}, seed {}", run.name, run.scenario.world, run.scenario.seed),
                    .facts = facts_of(run),
                    .sections = {{.title = "", .blocks = {verdict_of(run)}}},
                    .footer = fmt::format("Made by patrol report {} from the run's directory alone. Its scenario.yaml: {}.", PATROL_VERSION, run.origin_comment)};
  const auto add = [&](const std::string& title, Blocks blocks) {
    if (!blocks.empty()) page.sections.push_back({title, std::move(blocks)});
  };
  add("Key figures", key_metric_blocks(run));
  add("Replay", replay_blocks(run, page_file));
  add("Map", map_blocks(run));
  add("Error over time", error_blocks(run));
  add("Stations", station_blocks(run.metrics));
  add("Goals", goal_blocks(run.metrics));
  add("Inspection", inspection_blocks(run.metrics));
  add("Settings", settings_blocks(run));
  add("Performance", performance_blocks(run.metrics));
  if (!run.record.events.empty()) add("Events", {event_table(run)});
  return page;
}

}  // namespace patrol::app
