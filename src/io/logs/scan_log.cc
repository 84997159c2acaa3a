#include "io/logs/scan_log.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "core/error.h"
#include "io/logs/carmen_log.h"
#include "io/logs/mcap_scan_log.h"
#include "io/logs/no_return_detector.h"
#include "io/mcap/mcap_format.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMaxWarnings = 5;
constexpr int kMaxFirstPassScans = 5000;
constexpr double kMaxNoReturn_m = 1e4;  ///< maximum of the option no_return_m
/// Fewer beams with a range, and longer steps between scans, are more likely due to the units of the log.
constexpr double kMinReturnRatio = 0.05, kMaxMeanStep_s = 20.0;
constexpr std::uint64_t kMinHintBeams = 1000, kMinHintScans = 10;
/// Maximum number of distinct names of ignored messages: a damaged file may contain any number.
constexpr std::size_t kMaxNames = 50;

std::string counts(const std::map<std::string, std::uint64_t>& by_name) {
  std::string text;
  for (const auto& [name, count] : by_name) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  return text;
}

bool is_mcap(const std::filesystem::path& file) {
  std::string head(mcap::kMagic.size(), '\0');
  std::ifstream(file, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == mcap::kMagic;
}

std::unique_ptr<ScanLog> make_log(const std::filesystem::path& file, const ScanLogOptions& options,
                                  std::optional<double> gyro_bias_radps) {
  if (is_mcap(file)) return std::make_unique<McapScanLog>(file, options, gyro_bias_radps);
  return std::make_unique<CarmenLog>(file, options);
}

struct FirstPass {
  std::optional<NoReturnValue> no_return;
  GyroConsistency gyro = GyroConsistency::kUnknown;
  std::optional<double> gyro_bias_radps;
};

/// Runs the first pass over a log. Errors in the file are ignored here and reported by the actual pass.
FirstPass run_first_pass(const std::filesystem::path& file, ScanLogOptions options) {
  options.skip_invalid = true;
  options.no_return_m = kMaxNoReturn_m;
  const std::unique_ptr<ScanLog> log = make_log(file, options, {});
  NoReturnDetector finder;
  const auto is_conclusive = [&] {
    return finder.is_conclusive() && (log->gyro() == nullptr || log->gyro()->bias_radps());
  };
  try {
    for (int scans = 0; scans < kMaxFirstPassScans && !is_conclusive(); ++scans) {
      const std::optional<RecordedScan> recorded = log->next();
      if (!recorded) break;
      finder.add(*recorded);
    }
  } catch (const InputError&) {}
  if (!log->gyro()) return {.no_return = finder.find(), .gyro_bias_radps = {}};
  return {.no_return = finder.find(), .gyro = log->gyro()->consistency(), .gyro_bias_radps = log->gyro()->bias_radps()};
}

/// Returns the options changed by the results of the first pass, which are also described in `found`.
ScanLogOptions apply_first_pass(const FirstPass& first_pass, ScanLogOptions options, std::vector<std::string>& found) {
  if (options.detect_no_return && first_pass.no_return && first_pass.no_return->range_m <= options.no_return_m) {
    options.no_return_m = first_pass.no_return->range_m * (1.0 - 1e-6);  // margin for the rounded digits in the file
    found.push_back(fmt::format(
        "{:.4g} m encodes no return: {} identical readings at {} positions (log.detect_no_return)",
        first_pass.no_return->range_m, first_pass.no_return->num_readings, first_pass.no_return->num_positions));
  }
  if (options.imu != "auto") return options;
  options.imu = first_pass.gyro == GyroConsistency::kContradicts ? "on" : "off";
  if (first_pass.gyro == GyroConsistency::kAgrees)
    found.emplace_back("odometry yaw agrees with the gyro: odometry kept unchanged (log.imu)");
  if (first_pass.gyro == GyroConsistency::kUnrelated)
    found.emplace_back("odometry yaw and gyro are uncorrelated: gyro not used (log.imu)");
  return options;
}

}  // namespace

void ScanLog::count_ignored(const std::string& name) {
  const bool has_own_count = summary_.ignored.size() < kMaxNames || summary_.ignored.contains(name);
  ++summary_.ignored[has_own_count ? name : "others"];
}

void ScanLog::reject_or_skip(const ScanLogOptions& options, const std::string& reason, const std::string& warning) {
  if (!options.skip_invalid) throw InputError(warning);
  count_skipped(reason, warning);
}

void ScanLog::count_skipped(const std::string& reason, const std::string& warning) {
  ++summary_.skipped[reason];
  if (summary_.warnings.size() < kMaxWarnings) summary_.warnings.push_back(warning);
}

void ScanLog::sort_in(ScanSorter& sorter, RecordedScan scan, const ScanLogOptions& options,
                      const std::string& location) {
  const Time stamp = scan.scan.stamp;
  const ScanSorter::Order order = sorter.add(std::move(scan));
  if (order == ScanSorter::Order::kReordered) ++summary_.num_reordered;
  if (order != ScanSorter::Order::kTooLate) return;
  reject_or_skip(options, "scans out of order",
                 fmt::format("{}: stamp {:.6f} s after {:.6f} s, more than {} scans late: cannot be sorted", location,
                             to_seconds(stamp), to_seconds(*sorter.last_taken()), ScanSorter::kWindow));
}

void ScanLog::count_returned(const RecordedScan& scan) {
  const Time stamp = scan.scan.stamp;
  if (summary_.num_scans == 0) summary_.first_stamp = stamp;
  else if (summary_.last_stamp == stamp) ++summary_.num_same_stamp;
  summary_.last_stamp = stamp;
  ++summary_.num_scans;
  summary_.num_beams += scan.scan.ranges_m.size();
  summary_.num_returns += static_cast<std::uint64_t>(std::ranges::count_if(
      scan.scan.ranges_m, [](float range_m) { return std::isfinite(range_m) && range_m > 0.0F; }));
}

Time last_beam(const LaserScan& scan) {
  constexpr double kMaxDuration_s = 1.0;
  if (scan.ranges_m.empty()) return scan.stamp;
  const double span_s = scan.time_increment_s * static_cast<double>(scan.ranges_m.size() - 1);
  return span_s > 0.0 && span_s <= kMaxDuration_s ? scan.stamp + from_seconds(span_s) : scan.stamp;
}

std::string counted(const ScanLogSummary& summary) {
  std::string text = fmt::format("{} read", summary.num_read);
  for (const auto* const by_name : {&summary.ignored, &summary.skipped}) {
    if (!by_name->empty()) text += ", " + counts(*by_name);
  }
  return text;
}

namespace {

/// Hints at properties of a log that are unlikely in meters and seconds, a line each.
std::string unit_hints(const ScanLogSummary& summary) {
  std::string text;
  const auto ratio = [](auto part, auto whole) { return static_cast<double>(part) / static_cast<double>(whole); };
  if (summary.num_beams >= kMinHintBeams && ratio(summary.num_returns, summary.num_beams) < kMinReturnRatio) {
    text += fmt::format(
        "warning: only {:.1f} % of the beams have a return: ranges must be in meters (log.no_return_m is the range of "
        "a beam without return)\n",
        100.0 * ratio(summary.num_returns, summary.num_beams));
  }
  if (summary.num_scans < kMinHintScans) return text;
  const double step_s =
      to_seconds(summary.last_stamp - summary.first_stamp) / static_cast<double>(summary.num_scans - 1);
  if (step_s > kMaxMeanStep_s)
    text += fmt::format("warning: the scans are {:.0f} s apart on average: stamps must be in seconds\n", step_s);
  return text;
}

}  // namespace

std::string to_text(const ScanLogSummary& summary) {
  std::string text = fmt::format("{} scans", summary.num_scans);
  if (summary.num_reordered > 0) text += fmt::format(", {} sorted by stamp", summary.num_reordered);
  if (summary.num_same_stamp > 0)
    text += fmt::format(", {} with the stamp of the previous scan", summary.num_same_stamp);
  text += "\n";
  for (const std::string& what : summary.found) text += "detected: " + what + "\n";
  if (!summary.assumed.empty()) text += "assumed: " + counts(summary.assumed) + "\n";
  if (!summary.ignored.empty()) text += "ignored: " + counts(summary.ignored) + "\n";
  if (!summary.skipped.empty()) text += "skipped: " + counts(summary.skipped) + "\n";
  for (const std::string& warning : summary.warnings) text += "  " + warning + "\n";
  return text + unit_hints(summary);
}

std::unique_ptr<ScanLog> open_scan_log(const std::filesystem::path& file, const ScanLogOptions& options) {
  validate(options, "log");
  const bool needs_look = options.detect_no_return || options.imu != "off";
  const FirstPass first_pass = needs_look ? run_first_pass(file, options) : FirstPass{};
  std::vector<std::string> found;
  std::unique_ptr<ScanLog> log =
      make_log(file, apply_first_pass(first_pass, options, found), first_pass.gyro_bias_radps);
  for (const std::string& what : found) log->add_found(what);
  return log;
}

}  // namespace patrol::io
