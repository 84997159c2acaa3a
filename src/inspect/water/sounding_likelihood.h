#pragma once

#include <vector>

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
///
/// All models are linear combinations of fixed columns: the response of a body is, per gate, a quadratic form of the
/// coil axis, and that of the ground a multiple of that in unit conductivity. Their Gram matrix with the data is
/// computed once; a likelihood needs no sum over the data.
class SoundingLikelihood {
 public:
  /// Prepares the likelihood. Throws InputError if there are no soundings or their gates differ.
  SoundingLikelihood(const SoundingErrorSettings& settings, const std::vector<OrientedSounding>& soundings);

  /// Return log likelihoods up to a common constant. `direction`: unit vector from the coil to the center of the
  /// sphere, in the frame of yaw and pitch.
  double log_likelihood_rock(double rock_spm) const;
  double log_likelihood_body(double rock_spm, const ConductiveSphere& sphere, const Eigen::Vector3d& direction) const;

 private:
  static constexpr int kMaxColumns =
      15;  // columns of a Gram matrix: 4 of the body, 2 of the air, 7 of layers; rock; data
  using Gram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxColumns, kMaxColumns>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxColumns, 1>;

  Eigen::MatrixXd model_columns(const SoundingErrorSettings& settings, const std::vector<Eigen::Vector3d>& axes,
                                const Eigen::VectorXd& inverse_std, const Eigen::VectorXd& data) const;
  void set_gram(const Eigen::MatrixXd& nuisances, const Eigen::MatrixXd& columns);
  Gram body_gram(const GatedSphereResponse& body, const Eigen::Vector3d& direction) const;
  double log_likelihood(double rock_spm, const Gram& gram, Eigen::Index num_shape) const;

  TemGates gates_;
  std::vector<double> gate_s_;  ///< [gate]
  Eigen::Index num_gates_;
  Eigen::Index num_layer_;  ///< number of deviations by layers; 0 if not modeled
  double body_shape_std_;
  /// Gram matrix of the columns of `model_columns` in the metric of the data with integrated nuisances.
  Eigen::MatrixXd gram_;
};

}  // namespace patrol::inspect
