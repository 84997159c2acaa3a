#pragma once

#include "plan/navigation/recovery_behavior.h"

namespace patrol::plan {

/// Recovery that clears the costmap around the robot and turns once in place, so that all sensors observe the
/// surroundings.
class Spin : public RecoveryBehavior {
 public:
  explicit Spin(double rate_radps) : rate_radps_(rate_radps) {}

  const char* sentence() const override { return "Recovery: spinning in place."; }
  void begin(Time now, const Pose2& T_map_body, Costmap& costmap) override;
  std::optional<VelocityCommand> step(Time now, const Pose2& T_map_body) override;
  void serialize_state(StateArchive& archive) override;

 private:
  double rate_radps_;
  Time until_{};
  double turned_rad_ = 0.0;
  double yaw_before_rad_ = 0.0;
};

}  // namespace patrol::plan
