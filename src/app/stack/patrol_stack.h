#pragma once

#include <memory>
#include <optional>

#include "app/stack/robot_stack.h"

namespace patrol::app {

/// The quadruped's: it maps while it patrols. Leg odometry, levelling, SLAM, navigation, gas mission.
class PatrolStack final : public RobotStack {
 public:
  /// `route` in map, whose origin is the level body pose at the start. Throws InputError when settings, robot and route do
  /// not go together.
  PatrolStack(const StackSettings& settings, const RobotDescription& robot, const Route& route_in_map, double map_period_s,
              std::uint64_t seed, const BoostedStumps& neighbours = {});

  void handle_fall(Time now) override;
  bool mission_is_over() const override { return mission_.is_over(); }

 private:
  void use(const SensorMessage& message) override;
  void abort(Time now, EventKind kind, const std::string& text) override { say(mission_.abort(now, kind, text)); }
  std::optional<OdometryEstimate> odometry() const override { return odometry_.estimate(); }
  OccupancyGrid map() override { return slam_->map(); }
  bool is_mapping() const override { return true; }
  VelocityCommand control(Time now, const OdometryEstimate& odometry) override;
  void handle_scan(const LaserScan& scan);

  localize::BodyEstimator odometry_;
  localize::ScanLeveler leveler_;
  std::unique_ptr<slam::Mapper> slam_;
  inspect::Mission mission_;
  std::optional<GasReading> newest_gas_;
};

}  // namespace patrol::app
