#pragma once

#include <variant>

#include "core/calibration/calibration_estimate.h"
#include "core/messages.h"
#include "core/site/site_registration.h"

namespace patrol::stack {

/// Message published by the robot's software: estimates, map, commands, events and results.
using StackMessage =
    std::variant<OdometryEstimate, PoseEstimate, UwbPoseEstimate, LocalizationConfidence, ParticleSet, MapUpdate, Path,
                 TrajectoryEstimate, VelocityCommand, Event, ScanCommand, AntennaCommand, SoundingCommand,
                 WarningCommand, LiningResult, WaterResult, SiteRegistration, CalibrationEstimate>;

}  // namespace patrol::stack
