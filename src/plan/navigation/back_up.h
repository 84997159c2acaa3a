#pragma once

#include "plan/navigation/recovery_behavior.h"

namespace patrol::plan {

/// Recovery that clears the costmap around the robot and drives backwards for a time.
class BackUp : public RecoveryBehavior {
 public:
  BackUp(double duration_s, double speed_mps) : duration_s_(duration_s), speed_mps_(speed_mps) {}

  const char* sentence() const override { return "Recovery: backing up."; }
  void begin(Time now, const Pose2& T_map_body, Costmap& costmap) override;
  std::optional<VelocityCommand> step(Time now, const Pose2& T_map_body) override;
  void serialize_state(StateArchive& archive) override;

 private:
  double duration_s_, speed_mps_;
  Time until_{};
};

}  // namespace patrol::plan
