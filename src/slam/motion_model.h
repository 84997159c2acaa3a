#pragma once

#include "slam/motion_model_settings.h"
#include "slam/pose_gaussian.h"

namespace patrol::slam {

/// Predicts the body pose from `T_map_before` and the odometry increment `T_before_now` over `dt_s`.
///
/// Deviations from [Thrun05, section 5.4]:
/// - the increment is one motion instead of rotation, translation, rotation, because legs also move sideways;
/// - the standard deviations, not the variances, grow linearly with the distance: the errors of legs and gyro (scale,
///   bias) are correlated and do not average out.
PoseGaussian predict_motion(const Pose2& T_map_before, const Pose2& T_before_now, double dt_s,
                            const MotionModelSettings& settings);

}  // namespace patrol::slam
