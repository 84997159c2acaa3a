#pragma once

#include <span>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/uwb.h"
#include "localize/registration/registration_settings.h"
#include "localize/registration/site_measurement.h"

namespace patrol::localize {

/// Gaussian estimate of the pose of `map` in `site`: x, y, yaw; m, m, rad.
struct SitePoseGaussian {
  Pose2 T_site_map;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Returns the prior: the map begins at the surveyed start, within the put-down tolerance of the settings.
SitePoseGaussian registration_prior(const Pose2& T_site_start, const RegistrationSettings& settings);

/// Estimates the pose of the map in site from the prior and measurements in ascending time order. Maximum a posteriori
/// estimate with a Cauchy loss by iteratively reweighted Gauss-Newton; its scale decreases from 64 times the setting,
/// so that a wrong prior does not make correct measurements outliers (graduated non-convexity).
///
/// Measurements of one source are whitened as a first-order Gauss-Markov process, with the map's deformation as part of
/// their error. The covariance is that of the linearized problem; if the weighted residuals exceed their expectation,
/// the information of the measurements is divided by the ratio. The poses in map are taken as exact but for
/// `map_std_m`: a bend of the map longer than the correlation is not modeled. `calibration`: bias of UWB ranges. The
/// constant error of the ranges to each anchor (antenna delays) is estimated with the pose and eliminated.
SitePoseGaussian register_to_site(const SitePoseGaussian& prior, std::span<const SiteMeasurement> measurements,
                                  const RegistrationSettings& settings, const UwbCalibration& calibration = {});

}  // namespace patrol::localize
