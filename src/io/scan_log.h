#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/sensors/recorded_scan.h"
#include "core/settings.h"
#include "io/gyro_odometry.h"
#include "io/scan_sorter.h"

namespace patrol::io {

struct ScanLogOptions {
  bool skip_bad_lines = false;   ///< what cannot be read is counted instead of refused
  double no_return_m = 80.0;     ///< ranges from here on, or from the sensor's own maximum, are no returns
  bool finds_no_return = true;   ///< and so is a value that the log itself shows to be none (io/no_return.h)
  std::string carmen_laser;      ///< the message that holds the scans, as "FLASER"; empty: the best that the log has
  std::string scan_topic;        ///< of an MCAP file; empty: that of its first scan
  std::string odometry_topic;    ///< of an MCAP file; empty: that of its first odometry; without any: tf
  std::string imu = "auto";      ///< of an MCAP file: on, its gyro turns odometry (io/gyro_odometry.h); auto, where the log's first scans show that odometry turns otherwise
  std::string imu_topic = "";    ///< of an MCAP file; empty: that of its first IMU

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("skip_bad_lines", self.skip_bad_lines);
    visit("no_return_m", self.no_return_m, between(0.1, 1e4));
    visit("finds_no_return", self.finds_no_return);
    visit("carmen_laser", self.carmen_laser, one_of({"", "ROBOTLASER1", "FLASER", "RAWLASER1", "RLASER", "ROBOTLASER2", "RAWLASER2"}));
    visit("scan_topic", self.scan_topic);
    visit("odometry_topic", self.odometry_topic);
    visit("imu", self.imu, one_of({"auto", "on", "off"}));
    visit("imu_topic", self.imu_topic);
  }
};

/// What a log was found to hold, up to where it was read.
struct ScanLogSummary {
  std::uint64_t num_read = 0;       ///< lines, or messages
  std::uint64_t num_scans = 0;      ///< given out
  std::uint64_t num_reordered = 0;  ///< of these: came after a later one
  std::uint64_t num_same_stamp = 0;  ///< of these: bear the stamp of the one before
  std::map<std::string, std::uint64_t> ignored;  ///< by name of the message: not asked for, or not known
  std::vector<std::string> found;                ///< what the log itself showed, and was followed
  std::map<std::string, std::uint64_t> assumed;  ///< of these, by what: the file says nothing, or otherwise
  std::map<std::string, std::uint64_t> skipped;  ///< by reason: should have been of use
  std::vector<std::string> complaints;           ///< the first of what was skipped, each with its place
};

/// "12 lines, 3 SYNC, 4 lines that cannot be read": what a file without a scan held.
std::string counted(const ScanLogSummary& summary);

/// The summary in a few lines for a terminal.
std::string to_text(const ScanLogSummary& summary);

/// A recorded log of a 2D lidar and odometry, read from front to back: memory does not grow with the file. Ranges follow REP 117:
/// +Inf no return, NaN invalid (0 or less in the file).
///
/// Stamps never fall from scan to scan, but they may repeat: real logs have scans of one stamp, in the order in which they came. A
/// log's lines need not be in order; they are put in order as far as a few scans can be waited for (io/scan_sorter.h). A scan that
/// comes later than that is refused, or skipped.
class ScanLog {
 public:
  virtual ~ScanLog() = default;

  /// The next scan; none at the end. Throws InputError, naming file and place, at what cannot be read, and at the end when the
  /// file held no scan at all.
  virtual std::optional<RecordedScan> next() = 0;

  /// Share of the file that was read, 0 ... 1.
  virtual double progress() const = 0;

  const ScanLogSummary& summary() const { return summary_; }

  /// Notes in the summary what was found before this reading.
  void add_found(const std::string& what) { summary_.found.push_back(what); }

  /// The log's gyro and what the scans so far told of it; null where it has none.
  virtual const GyroOdometry* gyro() const { return nullptr; }

 protected:
  void count_ignored(const std::string& name);
  /// Throws InputError(complaint), or counts it when bad lines are skipped.
  void refuse_or_skip(const ScanLogOptions& options, const std::string& reason, const std::string& complaint);
  void count_skipped(const std::string& reason, const std::string& complaint);
  /// Refuses or skips a scan that comes too late to be put in order. `place`: what a complaint begins with.
  void sort_in(ScanSorter& sorter, RecordedScan scan, const ScanLogOptions& options, const std::string& place);
  void count_given_out(const RecordedScan& scan);

  ScanLogSummary summary_;

 private:
  std::optional<Time> last_stamp_;
};

/// Opens a log by what the file holds: MCAP, else CARMEN's text, plain or in gzip. Unless the options say otherwise its first scans are looked at first, for
/// what stands for no return, whether odometry turns as the gyro does, and the gyro's bias. Throws InputError.
std::unique_ptr<ScanLog> open_scan_log(const std::filesystem::path& file, const ScanLogOptions& options = {});

}  // namespace patrol::io
