#include "io/scan_log.h"

#include <fstream>

#include <fmt/format.h>

#include "core/error.h"
#include "io/carmen_log.h"
#include "io/mcap_format.h"
#include "io/mcap_scan_log.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMostComplaints = 5;
constexpr std::size_t kMostNames = 50;  ///< of ignored messages that are told apart: a damaged file may hold any number

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
  if (!summary.assumed.empty()) text += "assumed: " + counts(summary.assumed) + "\n";
  if (!summary.ignored.empty()) text += "ignored: " + counts(summary.ignored) + "\n";
  if (!summary.skipped.empty()) text += "skipped: " + counts(summary.skipped) + "\n";
  for (const std::string& complaint : summary.complaints) text += "  " + complaint + "\n";
  return text;
}

std::unique_ptr<ScanLog> open_scan_log(const std::filesystem::path& file, const ScanLogOptions& options) {
  validate(options, "log");
  if (is_mcap(file)) return std::make_unique<McapScanLog>(file, options);
  return std::make_unique<CarmenLog>(file, options);
}

}  // namespace patrol::io
