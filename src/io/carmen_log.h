#pragma once

#include <map>
#include <optional>
#include <string>

#include "io/carmen_message.h"
#include "io/line_reader.h"
#include "io/scan_log.h"
#include "io/scan_sorter.h"

namespace patrol::io {

/// A log of CARMEN (.log, .clf), plain or in gzip. The scans of one lidar are given out, with the robot's raw odometry; what is not
/// needed for that is ignored and counted.
///
/// - Which lidar, unless the options say so: of those that the log's first thousand lines hold, the one whose message says most.
/// - Beams: ROBOTLASERn and RAWLASERn say where they point. FLASER and RLASER have PARAM laser_front_laser_resolution (degrees), or
///   the step of the instruments that are known by their number of beams, else they span 180 deg. An even number of beams starts at
///   minus half the span and ends a step before its end (beam i of 180 at -90 deg + i), an odd number ends at it.
/// - The lidar's place is that of the log's first scan and then kept: its laser pose seen from its robot pose. Where these are equal
///   it is PARAM robot_frontlaser_offset (and _side_offset, _angular_offset), else zero; likewise where they are more than 2 m apart,
///   as in logs whose first pose was corrected afterwards. Later scans whose poses say otherwise are counted, not followed.
/// - RAWLASERn has no pose: it is given the newest ODOM before it, and skipped when there is none.
class CarmenLog : public ScanLog {
 public:
  CarmenLog(const std::filesystem::path& file, const ScanLogOptions& options);

  std::optional<RecordedScan> next() override;
  double progress() const override { return lines_.progress(); }

 private:
  bool read_line();
  void read_message(const LineReader::Line& line);
  void note_parameter(const CarmenParameter& parameter);
  void add(CarmenScan scan);
  Pose2 parameter_mount() const;
  Pose2 mount_of(const CarmenScan& scan);
  double old_step_deg(std::size_t num_beams, std::size_t num_steps) const;
  LaserScan to_laser_scan(CarmenScan scan) const;
  double parameter(const std::string& name, double otherwise) const;
  std::string place() const;
  void finish();

  ScanLogOptions options_;
  LineReader lines_;
  int line_ = 0;  ///< the number of the line at hand
  std::string laser_;
  std::map<std::string, double> parameters_;
  std::optional<CarmenOdometry> odometry_;
  std::optional<Pose2> T_body_lidar_;
  ScanSorter sorter_;
  bool is_at_end_ = false;
};

}  // namespace patrol::io
