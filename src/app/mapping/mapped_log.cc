#include "app/mapping/mapped_log.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/common/progress_bar.h"
#include "app/mapping/read_scans.h"
#include "slam/calibration/calibration.h"
#include "slam/consistency/odometry_check.h"
#include "slam/consistency/unsupported_path.h"
#include "slam/planar_scan.h"

namespace patrol::app {

bool map_log(io::ScanLog& log, const LogMappingSettings& settings, const std::string& name, slam::Mapper& mapper,
             MappedLog& mapped) {
  InterruptGuard guard;
  ProgressBar bar;
  slam::CalibratedScans calibrated(settings.calibration);
  std::optional<Pose2> T_first_odom, T_odom_last;
  const bool is_whole = read_scans(log, name, guard, bar, [&](RecordedScan& recorded) {
    mapped.frozen.add(recorded);
    calibrated.correct(recorded);
    const LevelScan scan = slam::planar_scan(recorded, settings.scan);
    mapped.consistency.add(scan, mapper.update(scan, recorded.T_odom_body));
    if (!T_first_odom) T_first_odom = recorded.T_odom_body.inverse();
    if (T_odom_last) mapped.distance_m += (recorded.T_odom_body.position() - T_odom_last->position()).norm();
    T_odom_last = recorded.T_odom_body;
    mapped.stamps.push_back(recorded.scan.stamp);
    mapped.T_odom_body.push_back(*T_first_odom * recorded.T_odom_body);
    mapped.cost.add(mapped.stamps.size(), mapped.distance_m);
  });
  if (!is_whole) return false;
  bar.show(fmt::format("{}  {} scans, final optimization", name, mapped.stamps.size()));
  mapper.finish();
  return !guard.is_interrupted();
}

MappingChecks check_mapping(const MappedLog& mapped, const std::vector<Pose2>& T_map_body,
                            const std::vector<slam::Keyframe>& earlier) {
  slam::MapConsistency map = mapped.consistency.check(T_map_body, earlier);
  map.frozen = mapped.frozen.find(T_map_body);
  OdometryReport odometry{.health = slam::check_odometry(mapped.T_odom_body, T_map_body, mapped.stamps),
                          .stamps = mapped.stamps,
                          .num_frozen_scans = slam::num_scans_of(map.frozen),
                          .num_unmatched_scans = map.num_unmatched + map.num_without_returns};
  map.unsupported = slam::find_unsupported_path(map.unmatched_segments, odometry.health.faulty, mapped.stamps);
  std::ranges::copy(slam::find_unsupported_gaps(mapped.T_odom_body, T_map_body, mapped.stamps),
                    std::back_inserter(map.unsupported));
  return {.consistency = {.consistency = std::move(map), .stamps = mapped.stamps}, .odometry = std::move(odometry)};
}

}  // namespace patrol::app
