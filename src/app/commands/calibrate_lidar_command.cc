#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "app/common/print_result.h"
#include "app/realism/lidar_calibration.h"
#include "io/files/atomic_file.h"
#include "io/files/csv.h"
#include "io/json/metrics_json.h"
#include "io/yaml/settings_yaml.h"
#include "report/page.h"

namespace patrol::app {
namespace {

const OutputKind kCalibratingLidar = {
    .name = "calibration of a lidar",
    .marker_text = "The calibration is incomplete.",
    .outputs = {"calibration.yaml", "lidar.yaml", "residuals.csv", "metrics.json", "settings.yaml", "index.html"},
    .required_file = "settings.yaml",
    .preserved = {"*.part"}};

LidarCalibrationSettings settings_of(const CalibrateOptions& options, const LogOnSiteOptions& site) {
  std::vector<std::string> overrides = options.overrides;
  if (options.skip_invalid) overrides.emplace_back("input.log.skip_invalid=true");
  LidarCalibrationSettings settings;
  settings.realism.positions.align = !is_path_exact(site);
  io::SettingsReader::read_section({"--set", overrides}, io::parse_overrides(overrides), "", settings);
  return settings;
}

}  // namespace

ExitCode calibrate_lidar_command(const CalibrateOptions& options) {
  LogOnSiteOptions site = options.site;
  site.log = options.log;
  const LidarCalibrationSettings settings = settings_of(options, site);
  const std::optional<RealismInput> input = read_realism_input(site, settings.realism);
  std::optional<LidarCalibration> calibration;
  if (input) calibration = calibrate_lidar(*input, settings);
  const OutputLock lock = begin_output(options.out, kCalibratingLidar);  // not earlier: a damaged log must leave none
  if (!calibration) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete\n", options.out.string());
    return ExitCode::kProgramFailed;
  }
  const std::string source =
      fmt::format("from {} in {}", options.log.filename().string(), input->source.world_xml.filename().string());
  const io::Metrics metrics = metrics_of(*calibration);
  const std::string warning = misfit_warning(calibration->by_preset.ks(), calibration->by_fit.ks());
  std::vector<std::string> notes = notes_of(*input, settings.realism, calibration->by_fit);
  if (!warning.empty()) notes.insert(notes.begin(), "Warning: " + warning + ".");
  const RealismContents contents{.kind = "lidar calibration",
                                 .title = fmt::format("Lidar of {}", options.log.filename().string()),
                                 .facts = facts_of(*input, settings.realism),
                                 .notes = std::move(notes),
                                 .first = {parameter_section(*calibration)}};
  io::save_text(options.out / "calibration.yaml", calibration_yaml(*calibration, source));
  io::save_settings(options.out / "lidar.yaml", preset_of(*calibration, *input),
                    source + "; for sensors.lidar.preset, as models/lidars/NAME.yaml or by its path");
  io::save_csv(options.out / "residuals.csv", residual_table(binned_residuals(calibration->by_fit)));
  io::save_metrics(options.out / "metrics.json", metrics);
  io::save_settings(options.out / "settings.yaml", settings);
  io::save_text(options.out / "index.html", report::to_html(realism_page(contents, calibration->by_fit)));
  complete_output(options.out);
  print_result(options.form,
               fmt::format("{}{}{}\n", io::to_text(input->scans.summary), table_text(*calibration),
                           (options.out / "lidar.yaml").string()),
               metrics);
  if (!warning.empty()) fmt::print(stderr, "patrol: {}: {}\n", options.log.string(), warning);
  return ExitCode::kDone;
}

}  // namespace patrol::app
