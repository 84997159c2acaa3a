#pragma once

#include "plan/navigation/recovery_behavior.h"

namespace patrol::plan {

/// Recovery that stops for a time: pedestrians move on.
class Wait : public RecoveryBehavior {
 public:
  explicit Wait(double duration_s) : duration_s_(duration_s) {}

  const char* sentence() const override { return "Recovery: waiting."; }
  void begin(Time now, const Pose2& T_map_body, Costmap& costmap) override;
  std::optional<VelocityCommand> step(Time now, const Pose2& T_map_body) override;
  void serialize_state(StateArchive& archive) override;

 private:
  double duration_s_;
  Time until_{};
};

}  // namespace patrol::plan
