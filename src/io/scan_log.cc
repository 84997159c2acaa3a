#include "io/scan_log.h"

#include <fstream>

#include <fmt/format.h>

#include "core/error.h"
#include "io/carmen_log.h"
#include "io/mcap_format.h"
#include "io/mcap_scan_log.h"
#include "io/no_return.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMostComplaints = 5;
constexpr int kMostScansLookedAt = 5000;
constexpr double kNoSuchRange_m = 1e4;  ///< maximum of the option no_return_m
/// Maximum number of distinct names of ignored messages: a damaged file may contain any number.
constexpr std::size_t kMostNames = 50;

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

std::unique_ptr<ScanLog> make_log(const std::filesystem::path& file, const ScanLogOptions& options, std::optional<double> gyro_bias_radps) {
  if (is_mcap(file)) return std::make_unique<McapScanLog>(file, options, gyro_bias_radps);
  return std::make_unique<CarmenLog>(file, options);
}

struct FirstLook {
  std::optional<NoReturnValue> no_return;
  GyroVerdict gyro = GyroVerdict::kUnknown;
  std::optional<double> gyro_bias_radps;
};

/// Runs the first pass over a log. Errors in the file are ignored here and reported by the actual pass.
FirstLook look_at(const std::filesystem::path& file, ScanLogOptions options) {
  options.skip_bad_lines = true;
  options.no_return_m = kNoSuchRange_m;
  const std::unique_ptr<ScanLog> log = make_log(file, options, {});
  NoReturnFinder finder;
  const auto has_seen_enough = [&] { return finder.has_seen_enough() && (!log->gyro() || log->gyro()->bias_radps()); };
  try {
    for (int scans = 0; scans < kMostScansLookedAt && !has_seen_enough(); ++scans) {
      const std::optional<RecordedScan> recorded = log->next();
      if (!recorded) break;
      finder.add(*recorded);
    }
  } catch (const InputError&) {
  }
  if (!log->gyro()) return {.no_return = finder.find(), .gyro_bias_radps = {}};
  return {.no_return = finder.find(), .gyro = log->gyro()->verdict(), .gyro_bias_radps = log->gyro()->bias_radps()};
}

/// Returns the options changed by the results of the first pass, which are also described in `found`.
ScanLogOptions followed(const FirstLook& look, ScanLogOptions options, std::vector<std::string>& found) {
  if (options.finds_no_return && look.no_return && look.no_return->range_m <= options.no_return_m) {
    options.no_return_m = look.no_return->range_m * (1.0 - 1e-6);  // margin for the rounded digits in the file
    found.push_back(fmt::format("{:.4g} m is no return: {} readings from {} places are it to the bit (log.finds_no_return)", look.no_return->range_m,
                                look.no_return->num_readings, look.no_return->num_places));
  }
  if (options.imu != "auto") return options;
  options.imu = look.gyro == GyroVerdict::kContradicts ? "on" : "off";
  if (look.gyro == GyroVerdict::kAgrees) found.push_back("odometry turns as the gyro does: it is kept (log.imu)");
  if (look.gyro == GyroVerdict::kUnrelated) found.push_back("odometry's turns and the gyro's have little in common: the gyro is not used (log.imu)");
  return options;
}

}  // namespace

void ScanLog::count_ignored(const std::string& name) {
  const bool is_told_apart = summary_.ignored.size() < kMostNames || summary_.ignored.contains(name);
  ++summary_.ignored[is_told_apart ? name : "others"];
}

void ScanLog::refuse_or_skip(const ScanLogOptions& options, const std::string& reason, const std::string& complaint) {
  if (!options.skip_bad_lines) throw InputError(complaint);
  count_skipped(reason, complaint);
}

void ScanLog::count_skipped(const std::string& reason, const std::string& complaint) {
  ++summary_.skipped[reason];
  if (summary_.complaints.size() < kMostComplaints) summary_.complaints.push_back(complaint);
}

void ScanLog::sort_in(ScanSorter& sorter, RecordedScan scan, const ScanLogOptions& options, const std::string& place) {
  const Time stamp = scan.scan.stamp;
  const ScanSorter::Order order = sorter.add(std::move(scan));
  if (order == ScanSorter::Order::kReordered) ++summary_.num_reordered;
  if (order != ScanSorter::Order::kTooLate) return;
  refuse_or_skip(options, "scans whose time goes back",
                 fmt::format("{}: time goes back to {:.6f} s, but {:.6f} s was {} scans ago: too late to put them in order", place, to_seconds(stamp),
                             to_seconds(*sorter.last_taken()), ScanSorter::kWindow));
}

void ScanLog::count_given_out(const RecordedScan& scan) {
  ++summary_.num_scans;
  if (last_stamp_ == scan.scan.stamp) ++summary_.num_same_stamp;
  last_stamp_ = scan.scan.stamp;
}

std::string counted(const ScanLogSummary& summary) {
  std::string text = fmt::format("{} read", summary.num_read);
  for (const auto* const by_name : {&summary.ignored, &summary.skipped}) {
    if (!by_name->empty()) text += ", " + counts(*by_name);
  }
  return text;
}

std::string to_text(const ScanLogSummary& summary) {
  std::string text = fmt::format("{} scans", summary.num_scans);
  if (summary.num_reordered > 0) text += fmt::format(", {} put in order of time", summary.num_reordered);
  if (summary.num_same_stamp > 0) text += fmt::format(", {} with the stamp of the one before", summary.num_same_stamp);
  text += "\n";
  for (const std::string& what : summary.found) text += "found: " + what + "\n";
  if (!summary.assumed.empty()) text += "assumed: " + counts(summary.assumed) + "\n";
  if (!summary.ignored.empty()) text += "ignored: " + counts(summary.ignored) + "\n";
  if (!summary.skipped.empty()) text += "skipped: " + counts(summary.skipped) + "\n";
  for (const std::string& complaint : summary.complaints) text += "  " + complaint + "\n";
  return text;
}

std::unique_ptr<ScanLog> open_scan_log(const std::filesystem::path& file, const ScanLogOptions& options) {
  validate(options, "log");
  const bool needs_look = options.finds_no_return || options.imu != "off";
  const FirstLook look = needs_look ? look_at(file, options) : FirstLook{};
  std::vector<std::string> found;
  std::unique_ptr<ScanLog> log = make_log(file, followed(look, options, found), look.gyro_bias_radps);
  for (const std::string& what : found) log->add_found(what);
  return log;
}

}  // namespace patrol::io
