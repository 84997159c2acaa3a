#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "app/common/progress_bar.h"
#include "app/scenario/data_folders.h"
#include "app/scenario/sensor_needs.h"
#include "app/scoring/localizability_map.h"
#include "app/scoring/mapping_lidar.h"
#include "core/error.h"
#include "core/geometry/angles.h"
#include "io/files/csv.h"
#include "render/heat_map.h"
#include "score/statistics.h"

namespace patrol::app {
namespace {

const OutputKind kLocalizability = {.name = "localizability map",
                                    .marker_text = "Incomplete: not every position has been evaluated.",
                                    .outputs = {"localizability.csv", "localizability.png", "*.part"},
                                    .required_file = "localizability.csv",
                                    .preserved = {}};

/// Maps a standard deviation to a logarithmic scale from 0.1 mm to 1 m.
double to_color_scale(double std_m) { return std::log10(std::clamp(std_m, 1e-4, 1.0)) / 4.0 + 1.0; }

io::Table table_of(const LocalizabilityMap& map) {
  io::Table table{.name = "localizability",
                  .columns = {"x_m", "y_m", "weak_std_m", "weak_direction_deg", "strong_std_m", "returns"},
                  .rows = {}};
  for (const LocalizabilitySample& sample : map.positions) {
    table.rows.push_back({sample.p_world_m.x(), sample.p_world_m.y(), sample.truth.max_std_m,
                          to_deg(sample.truth.max_std_direction_rad), sample.truth.min_std_m,
                          static_cast<std::int64_t>(sample.truth.num_returns)});
  }
  return table;
}

render::Frame picture_of(const LocalizabilityMap& map, const std::string& where) {
  render::HeatMap heat{
      .surfaces = map.surfaces,
      .step_m = map.step_m,
      .positions = {},
      .title = fmt::format("{}: bound of a single scan", where),
      .note = fmt::format("maximum standard deviation; strokes: its direction, above {:g} cm",
                          100.0 * score::Localizability::kDegenerate_m),
      .scale = {{0.0, "0.1 mm"}, {0.25, "1 mm"}, {0.5, "1 cm"}, {0.75, "10 cm"}, {1.0, "1 m or more"}}};
  for (const LocalizabilitySample& sample : map.positions) {
    heat.positions.push_back({.p_m = sample.p_world_m,
                              .color_fraction = to_color_scale(sample.truth.max_std_m),
                              .has_stroke = sample.truth.is_degenerate(),
                              .stroke_rad = sample.truth.max_std_direction_rad});
  }
  return render::draw_heat_map(heat);
}

}  // namespace

ExitCode localizability_command(const LocalizabilityOptions& options) {
  if (!(options.grid_step_m >= 0.05 && options.grid_step_m <= 10.0))
    throw InputError(fmt::format("--grid-step-m {}: must be in [0.05, 10]", options.grid_step_m));
  const Scenario scenario = load_scenario(options.scenario, options.overrides);
  const ScenarioFiles files = load_scenario_files(scenario, find_data_root(options.scenario));
  if (!mapping_lidar(files.robot))
    require_sensors({{.sensor = "lidar", .by = "patrol localizability"}}, files.robot, scenario.robot,
                    scenario.robot_location);
  ProgressBar bar;
  const LocalizabilityMap map = map_localizability(scenario, files, options.grid_step_m, [&](double fraction) {
    bar.show(fmt::format("localizability  {:3.0f} %", 100.0 * fraction), fraction);
  });
  const OutputLock lock = begin_output(options.out, kLocalizability);
  io::save_csv(options.out / "localizability.csv", table_of(map));
  render::save_png(options.out / "localizability.png", picture_of(map, scenario.world));
  complete_output(options.out);

  std::vector<double> max_std_m;
  for (const LocalizabilitySample& sample : map.positions) max_std_m.push_back(sample.truth.max_std_m);
  const auto num_degenerate = std::count_if(map.positions.begin(), map.positions.end(),
                                            [](const auto& sample) { return sample.truth.is_degenerate(); });
  fmt::print(
      "{} positions, spacing {:g} m: maximum standard deviation of one scan {:.4f} m (median), {:.4f} m (95th "
      "percentile);\n",
      map.positions.size(), options.grid_step_m, score::percentile(max_std_m, 0.5), score::percentile(max_std_m, 0.95));
  fmt::print("{:.1f} % are degenerate (more than {} m).\n{}\n",
             100.0 * static_cast<double>(num_degenerate) / static_cast<double>(map.positions.size()),
             score::Localizability::kDegenerate_m, (options.out / "localizability.png").string());
  return ExitCode::kDone;
}

}  // namespace patrol::app
