#pragma once

#include <map>
#include <optional>
#include <string>

#include "io/files/line_reader.h"
#include "io/logs/carmen_message.h"
#include "io/logs/scan_log.h"
#include "io/logs/scan_sorter.h"

namespace patrol::io {

/// Reader of a CARMEN log (.log, .clf), plain or gzip-compressed. Returns the scans of one lidar with the raw odometry
/// of the robot; other messages are ignored and counted.
///
/// - Lidar, unless set in the options: the one with the most informative message among those in the first thousand
///   lines.
/// - Beam angles: given in ROBOTLASERn and RAWLASERn. For FLASER and RLASER the step is PARAM
///   laser_front_laser_resolution (degrees), or that of the instruments known by their number of beams; otherwise the
///   span is 180 deg. An even number of beams starts at minus half the span and ends one step before its end (beam i of
///   180 at -90 deg + i); an odd number includes the end.
/// - Lidar pose in the body: the laser pose of the first scan relative to its robot pose, constant from then on. If
///   these poses are equal: PARAM robot_frontlaser_offset (and _side_offset, _angular_offset), otherwise zero. The
///   parameters also apply if the poses are more than 2 m apart, as in logs whose first pose was corrected afterwards.
///   Later scans with a different relative pose are counted; their relative pose is ignored.
/// - RAWLASERn has no pose: it gets the pose of the preceding ODOM message, and is skipped if there is none.
class CarmenLog : public ScanLog {
 public:
  CarmenLog(const std::filesystem::path& file, const ScanLogOptions& options);

  std::optional<RecordedScan> next() override;
  double progress() const override { return lines_.progress(); }

 private:
  bool read_line();
  void read_message(const LineReader::Line& line);
  void store_parameter(const CarmenParameter& parameter);
  void add(CarmenScan scan);
  Pose2 parameter_mount() const;
  Pose2 mount_of(const CarmenScan& scan);
  double old_step_deg(std::size_t num_beams, std::size_t num_steps) const;
  LaserScan to_laser_scan(CarmenScan scan) const;
  double parameter(const std::string& name, double otherwise) const;
  std::string location() const;
  void finish();

  ScanLogOptions options_;
  LineReader lines_;
  int line_ = 0;  ///< number of the current line
  std::string laser_;
  std::map<std::string, double> parameters_;
  std::optional<CarmenOdometry> odometry_;
  std::optional<Pose2> T_body_lidar_;
  ScanSorter sorter_;
  bool is_at_end_ = false;
};

}  // namespace patrol::io
