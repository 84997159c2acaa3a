#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "app/common/print_result.h"
#include "app/mapping/read_scans.h"
#include "app/record/run_directory.h"
#include "core/error.h"
#include "core/geometry/angles.h"
#include "io/files/csv.h"
#include "io/json/metrics_json.h"
#include "io/logs/scan_log.h"
#include "io/yaml/settings_yaml.h"
#include "slam/calibration/calibrate.h"
#include "slam/calibration/calibration_contradiction.h"

namespace patrol::app {
namespace {

const OutputKind kCalibrating = {.name = "calibration of a log",
                                 .marker_text = "The calibration is incomplete.",
                                 .outputs = {"calibration.yaml", "segments.csv", "metrics.json", "settings.yaml"},
                                 .required_file = "settings.yaml",
                                 .preserved = {"*.part"}};

/// Settings of `patrol calibrate --set`.
struct LogCalibrationSettings {
  int passes = 2;  ///< passes over the log; each uses the calibration of the one before
  io::ScanLogOptions log;
  slam::PlanarScanSettings scan;
  slam::MotionSegmentSettings segments;
  slam::CalibratorSettings calibrator;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("passes", self.passes, between(1, 10));
    visit("log", self.log);
    visit("scan", self.scan);
    visit("segments", self.segments);
    visit("calibrator", self.calibrator);
  }
};

/// Result of a pass over the log.
struct CalibratedLog {
  io::ScanLogSummary summary;
  Pose2 T_body_lidar;  ///< lidar pose of the log's first scan
  std::vector<slam::MotionSegment> pairs;
  slam::CalibrationResult result;
};

/// Calibrates in one pass over the log; none if interrupted.
std::optional<CalibratedLog> calibrate_once(const std::filesystem::path& file, const LogCalibrationSettings& settings,
                                            const slam::Calibration& prior, const std::string& name) {
  const InterruptGuard guard;
  ProgressBar bar;
  const std::unique_ptr<io::ScanLog> log = io::open_scan_log(file, settings.log);
  slam::MotionSegmenter pairs(settings.segments, settings.scan, prior);
  std::optional<Pose2> T_body_lidar;
  const bool is_whole = read_scans(*log, name, guard, bar, [&](const RecordedScan& recorded) {
    if (!T_body_lidar) T_body_lidar = recorded.T_body_lidar;
    pairs.add(recorded);
  });
  if (!is_whole) return std::nullopt;
  CalibratedLog calibrated{
      .summary = log->summary(), .T_body_lidar = *T_body_lidar, .pairs = pairs.pairs(), .result = {}};
  try {
    calibrated.result = slam::calibrate(calibrated.pairs, calibrated.T_body_lidar, settings.calibrator);
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  return calibrated;
}

/// Table of the motion of each segment by odometry and by scan matching, with its error, which shows rejected segments.
io::Table segment_table(const CalibratedLog& log) {
  io::Table table{.name = "segments",
                  .columns = {"begin_s", "end_s", "odometry_x_m", "odometry_y_m", "odometry_yaw_rad", "lidar_x_m",
                              "lidar_y_m", "lidar_yaw_rad", "error_std"},
                  .rows = {}};
  for (std::size_t k = 0; k < log.pairs.size(); ++k) {
    const slam::MotionSegment& pair = log.pairs[k];
    const Pose2 lidar = pair.lidar();
    table.rows.push_back({to_seconds(pair.begin), to_seconds(pair.end), pair.odometry.x, pair.odometry.y,
                          pair.odometry.yaw, lidar.x, lidar.y, lidar.yaw, log.result.errors[k]});
  }
  return table;
}

io::Metrics metrics_of(const CalibratedLog& log) {
  io::Metrics metrics;
  const slam::CalibrationResult& result = log.result;
  metrics["log"] = {{"scans", log.summary.num_scans}};
  metrics["stretches"] = {{"count", result.num_segments},
                          {"rejected", result.num_rejected},
                          {"move_noise", result.translation_noise_scale},
                          {"turn_noise", result.rotation_noise_scale}};
  metrics["converged"] = result.converged;
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    const slam::CalibratedParameter& parameter = result.parameters[i];
    metrics["calibration"][slam::kCalibrationParameters[i]] = {{"before", parameter.before},
                                                               {"value", parameter.value},
                                                               {"std", parameter.std},
                                                               {"observable", parameter.is_observable}};
  }
  return metrics;
}

std::string table_text(const slam::CalibrationResult& result) {
  struct Row {
    const char* name;
    double factor;
    const char* unit;
    int decimals;
  };
  constexpr std::array<Row, 6> kRows = {{{"lidar x in body", 1.0, "m", 4},
                                         {"lidar y in body", 1.0, "m", 4},
                                         {"lidar yaw in body", kDegPerRad, "deg", 3},
                                         {"distance scale", 1.0, "", 5},
                                         {"rotation scale", 1.0, "", 5},
                                         {"steering bias", kDegPerRad, "deg/m", 3}}};
  std::string text = fmt::format("{:<26} {:>10} {:>11} {:>9}\n", "", "in the log", "calibrated", "std");
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    const Row& row = kRows[i];
    const slam::CalibratedParameter& parameter = result.parameters[i];
    const auto number = [&](double value) { return fmt::format("{:.{}f}", row.factor * value, row.decimals); };
    text += fmt::format("{:<26} {:>10} {:>11} {:>9} {}\n", row.name, number(parameter.before),
                        parameter.is_observable ? number(parameter.value) : "-", number(parameter.std),
                        parameter.is_observable ? row.unit : fmt::format("{} not observable: unchanged", row.unit));
  }
  return text;
}

}  // namespace

ExitCode calibrate_command(const CalibrateOptions& options) {
  if (options.sensor == "lidar") return calibrate_lidar_command(options);
  if (!options.site.site.empty() || !options.site.trajectory.empty() || !options.site.lidar.empty())
    throw InputError("--site, --trajectory and --lidar: only with --sensor lidar");
  std::vector<std::string> overrides = options.overrides;
  if (options.skip_invalid) overrides.emplace_back("log.skip_invalid=true");
  const auto settings = io::parse_settings<LogCalibrationSettings>(overrides);
  const std::filesystem::path file = log_of(options.log);
  std::optional<CalibratedLog> log;
  for (int pass = 1; pass <= settings.passes; ++pass) {
    const slam::Calibration prior = log ? log->result.calibration() : slam::Calibration{};
    log = calibrate_once(file, settings, prior,
                         fmt::format("{}, {} of {}", file.filename().string(), pass, settings.passes));
    if (!log) break;
  }
  if (log) {
    const std::string reason =
        slam::calibration_contradiction(log->pairs, log->result, settings.calibrator.min_segments);
    if (!reason.empty()) throw InputError(fmt::format("{}: {}", file.string(), reason));
  }
  const OutputLock lock = begin_output(options.out, kCalibrating);  // not earlier: a damaged log must leave no output
  if (!log) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete\n", options.out.string());
    return ExitCode::kProgramFailed;
  }
  const slam::CalibrationResult& result = log->result;
  io::save_settings(options.out / "calibration.yaml", result.calibration(),
                    "from " + file.filename().string() + "; for patrol slam --calibration");
  io::save_csv(options.out / "segments.csv", segment_table(*log));
  io::save_metrics(options.out / "metrics.json", metrics_of(*log));
  io::save_settings(options.out / "settings.yaml", settings);
  complete_output(options.out);

  const std::string text = fmt::format(
      "{}{} segments, {} of them rejected (wheel slip, odometry error or wrong match){}\n{}{}\n",
      io::to_text(log->summary), result.num_segments, result.num_rejected, result.converged ? "" : "; not converged",
      table_text(result), (options.out / "calibration.yaml").string());
  print_result(options.form, text, metrics_of(*log));
  return result.converged ? ExitCode::kDone : ExitCode::kExpectationMissed;
}

}  // namespace patrol::app
