#include "app/stack/log_mapper.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/thread_clock.h"
#include "io/run_log.h"

namespace patrol::app {

LogMapper::LogMapper(const StackSettings& settings, const RobotDescription& robot, std::uint64_t seed)
    : odometry_(robot, settings.odometry), leveler_(robot.T_body("lidar"), settings.leveling), slam_(make_mapper(settings, {}, seed)), settle_(from_seconds(settings.settle_s)) {}

void LogMapper::map(const std::filesystem::path& log_mcap) {
  io::LogHandlers handlers;
  handlers.imu = [&](Time, const Imu& imu) { odometry_.add(imu); };
  handlers.joints = [&](Time, const JointState& joints) { odometry_.add(joints); };
  handlers.contacts = [&](Time, const FootContacts& contacts) { odometry_.add(contacts); };
  handlers.scan = [&](Time, const LaserScan& scan) { handle(scan); };
  io::read_run_log(log_mcap, handlers);
  if (T_map_body_.empty()) throw InputError(fmt::format("{}: no scan in it could be mapped", log_mcap.string()));
}

void LogMapper::handle(const LaserScan& raw) {
  if (!first_odometry_) {
    if (const auto estimate = odometry_.estimate()) first_odometry_ = estimate->stamp;
  }
  if (!first_odometry_ || raw.stamp < *first_odometry_ + settle_) return;
  const std::optional<LevelScan> scan = leveler_.level(raw, odometry_);
  if (!scan) return;
  const double start_s = thread_seconds();
  const slam::SlamUpdate update = slam_->update(*scan, to_planar(*odometry_.T_odom_body_at(scan->stamp)));
  seconds_ += thread_seconds() - start_s;
  T_map_body_.push_back({.stamp = scan->stamp, .pose = to_spatial(update.T_map_body)});
}

}  // namespace patrol::app
