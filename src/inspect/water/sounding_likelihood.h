#pragma once

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "core/sensors/tem_response.h"
#include "inspect/water/water_settings.h"
#include "inspect/water/water_sounding.h"

namespace patrol::inspect {

/// Likelihood of soundings for rock alone and for rock with a conductive sphere. Nuisance parameters are linear with
/// normal priors and are integrated out in closed form [Rasmussen06, section 2.7]: gains, time shift, and nearby steel.
/// The response of a conductor of any shape is a sum of exponential decays; here the time constants are 10, 30, 100 and
/// 300 us. Each decay has an isotropic part and one that is a quadratic form of the coil axis. So have the responses of
/// the tunnel's air and of layers, which the models of the rock lack; they are proportional to the signal. The response
/// of a body deviates from that of a sphere by factors along and across the line of sight.
class SoundingLikelihood {
 public:
  /// Prepares the likelihood. Throws InputError if there are no soundings or their gates differ.
  SoundingLikelihood(const SoundingErrorSettings& settings, const std::vector<OrientedSounding>& soundings);

  /// Return log likelihoods up to a common constant. `towards`: unit vector from the coil to the center of the sphere,
  /// in the frame of yaw and pitch.
  double log_likelihood_rock(double rock_spm) const;
  double log_likelihood_body(double rock_spm, const ConductiveSphere& sphere, const Eigen::Vector3d& direction) const;

 private:
  double log_likelihood_residual(const Eigen::VectorXd& whitened) const;
  double log_likelihood_residual(const Eigen::VectorXd& whitened, const Eigen::MatrixXd& deviations) const;
  void set_ground_deviations(const SoundingErrorSettings& settings);
  Eigen::MatrixXd deviations(double rock_spm, Eigen::Index num_others) const;
  Eigen::MatrixXd shape_deviations(const GatedSphereResponse& body, const Eigen::Vector3d& direction) const;

  TemGates gates_;
  std::vector<double> gate_s_;  ///< [gate]
  Eigen::Index num_gates_;
  double body_shape_std_;
  std::vector<Eigen::Vector3d> axes_;  ///< [sounding]
  // Stacked by sounding, then gate; per unit moment; divided by the standard deviation.
  Eigen::VectorXd data_, inverse_std_;
  Eigen::MatrixXd nuisances_;  ///< [datum][nuisance], scaled to unit prior standard deviation
  Eigen::LLT<Eigen::MatrixXd> nuisance_information_;
  Eigen::MatrixXd air_, layer_;  ///< [datum][deviation], in rock of unit conductivity; without columns if not modeled
};

}  // namespace patrol::inspect
