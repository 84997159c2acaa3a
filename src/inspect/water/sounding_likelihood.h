#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <vector>

#include "core/tem_response.h"
#include "inspect/water/water_settings.h"
#include "inspect/water/water_sounding.h"

namespace patrol::inspect {

/// How well a rock, and a body in it, explain the soundings. What is of no interest enters linearly, has a normal prior and is integrated out in
/// closed form: the gains, the shift of time, and steel: what a conductor of any shape does is a sum of exponential decays, here of 10, 30, 100 and
/// 300 us, each with a share that is the same in all directions and one that is a quadratic form of the coil's axis (Rasmussen and Williams, "Gaussian
/// processes for machine learning", 2006, section 2.7).
class SoundingLikelihood {
 public:
  /// Throws InputError for soundings whose gates differ, or without any.
  SoundingLikelihood(const SoundingErrorSettings& settings, const std::vector<AimedSounding>& soundings);

  /// Logarithms, but for a constant that all have in common. `towards`: unit vector from the coil to the body, in the frame that yaw and
  /// pitch are counted in.
  double of_rock(double rock_spm) const;
  double of_body(double rock_spm, const ConductiveSphere& sphere, const Eigen::Vector3d& towards) const;

 private:
  double of_residual(const Eigen::VectorXd& whitened) const;

  TemGates gates_;
  Eigen::Index num_gates_;
  std::vector<Eigen::Vector3d> axes_;  ///< [sounding]
  // The rest is sounding by sounding, gate by gate, per unit of moment, divided by the standard deviation.
  Eigen::VectorXd data_, inverse_std_;
  Eigen::MatrixXd nuisances_;  ///< [datum][nuisance], each worth one standard deviation of its prior
  Eigen::LLT<Eigen::MatrixXd> nuisance_information_;
};

}  // namespace patrol::inspect
