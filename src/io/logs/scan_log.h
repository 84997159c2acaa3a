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
#include "io/logs/cloud_slice.h"
#include "io/logs/gyro_odometry.h"
#include "io/logs/scan_sorter.h"

namespace patrol::io {

struct ScanLogOptions {
  bool skip_invalid = false;  ///< whether unreadable records are counted and skipped instead of an error
  double no_return_m = 80.0;  ///< range from which on, or from the maximum of the sensor, a beam has no return
  bool detect_no_return =
      true;  ///< whether a range value in the log that encodes "no return" is detected (io/logs/no_return_detector.h)
  std::string carmen_laser;  ///< message with the scans, e.g. "FLASER"; empty: the most informative one in the log
  /// Topic of LaserScan or PointCloud2 messages, several separated by commas; empty: topic of the first LaserScan; MCAP
  /// only.
  std::string scan_topic;
  /// Topic of odometry; empty: topic of the first odometry message, or tf if there is none; MCAP only.
  std::string odometry_topic;
  /// Use of yaw increments from the gyro (io/logs/gyro_odometry.h): on, off, or auto: only if the first scans show that
  /// gyro and odometry disagree; MCAP only.
  std::string imu = "auto";
  std::string imu_topic = {};  ///< topic of the IMU; empty: topic of the first IMU message; MCAP only
  CloudSliceSettings cloud = {};

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("skip_invalid", self.skip_invalid);
    visit("no_return_m", self.no_return_m, between(0.1, 1e4));
    visit("detect_no_return", self.detect_no_return);
    visit("carmen_laser", self.carmen_laser,
          one_of({"", "ROBOTLASER1", "FLASER", "RAWLASER1", "RLASER", "ROBOTLASER2", "RAWLASER2"}));
    visit("scan_topic", self.scan_topic);
    visit("odometry_topic", self.odometry_topic);
    visit("imu", self.imu, one_of({"auto", "on", "off"}));
    visit("imu_topic", self.imu_topic);
    visit("cloud", self.cloud);
  }
};

/// Statistics of a log up to the current position.
struct ScanLogSummary {
  std::uint64_t num_read = 0;                    ///< number of lines or messages read
  std::uint64_t num_scans = 0;                   ///< number of scans returned
  std::uint64_t num_reordered = 0;               ///< number of these that were preceded by a later scan in the file
  std::uint64_t num_same_stamp = 0;              ///< number of these with the same stamp as the previous scan
  std::uint64_t num_beams = 0, num_returns = 0;  ///< number of their beams, and of beams with a range
  Time first_stamp{}, last_stamp{};              ///< stamps of the first and the last scan
  std::map<std::string, std::uint64_t> ignored;  ///< number by message name: not selected, or of unknown type
  std::vector<std::string> found;                ///< properties detected in the log and applied
  /// Number of scans by assumption: the file has no or conflicting information.
  std::map<std::string, std::uint64_t> assumed;
  std::map<std::string, std::uint64_t> skipped;  ///< number by reason: needed, but unusable
  std::vector<std::string> warnings;             ///< first errors of skipped records, each with its position
};

/// Returns the time of the last beam, or of the first if the scan has no plausible beam times.
Time last_beam(const LaserScan& scan);

/// Formats the statistics of a file without scans: "12 lines, 3 SYNC, 4 unreadable lines".
std::string counted(const ScanLogSummary& summary);

/// Formats the statistics in a few lines for a terminal, with hints at wrong units of ranges and stamps.
std::string to_text(const ScanLogSummary& summary);

/// Sequential reader of a recorded log of 2D lidar and odometry; memory does not grow with the file. Ranges follow REP
/// 117: +Inf no return, NaN invalid (0 or less in the file).
///
/// Stamps never decrease from scan to scan but may repeat; scans with equal stamps keep the order of the file. Records
/// may be out of order: they are sorted within a window of a few scans (io/logs/scan_sorter.h). A scan that arrives
/// later than that is an error or is skipped.
class ScanLog {
 public:
  virtual ~ScanLog() = default;

  /// Returns the next scan; nullopt at the end. Throws InputError with file and position for an unreadable record, and
  /// at the end if the file contained no scan.
  virtual std::optional<RecordedScan> next() = 0;

  /// Returns the fraction of the file read, 0 to 1.
  virtual double progress() const = 0;

  const ScanLogSummary& summary() const { return summary_; }

  /// Adds to the summary a property that was detected before this pass.
  void add_found(const std::string& what) { summary_.found.push_back(what); }

  /// Returns the gyro of the log with its statistics so far; null if the log has none.
  virtual const GyroOdometry* gyro() const { return nullptr; }

 protected:
  void count_read() { ++summary_.num_read; }
  void count_ignored(const std::string& name);
  void count_assumed(const std::string& assumption) { ++summary_.assumed[assumption]; }
  /// Throws InputError(complaint), or counts it if `skip_invalid` is set.
  void reject_or_skip(const ScanLogOptions& options, const std::string& reason, const std::string& warning);
  void count_skipped(const std::string& reason, const std::string& warning);
  /// Adds a scan to the sorter; rejects or skips one that is too late for sorting. `location`: prefix of the error
  /// message.
  void sort_in(ScanSorter& sorter, RecordedScan scan, const ScanLogOptions& options, const std::string& location);
  void count_returned(const RecordedScan& scan);

 private:
  ScanLogSummary summary_;
};

/// Opens a log by the content of the file: MCAP, otherwise CARMEN text, plain or gzip-compressed. Unless disabled in
/// the options, a first pass over the first scans detects the "no return" value, disagreement between gyro and
/// odometry, and the gyro bias. Throws InputError.
std::unique_ptr<ScanLog> open_scan_log(const std::filesystem::path& file, const ScanLogOptions& options = {});

}  // namespace patrol::io
