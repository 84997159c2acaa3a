#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <vector>

#include "core/settings.h"
#include "core/tem_response.h"
#include "inspect/water/water_sounding.h"

namespace patrol::inspect {

/// What is known of the instrument (its data sheet) and how far it, the mount and the model are trusted; standard deviations.
struct SoundingErrorSettings {
  double ramp_s = 2.6e-6;             ///< the current's
  double gate_width = 0.15;           ///< of a gate, over its middle
  double model_std = 0.02;            ///< of a gate's rate, over it: what the model leaves out
  double gain_std = 0.03;             ///< the same in all soundings
  double sounding_gain_std = 0.01;    ///< from one to the next: the current, and the coil's angle
  double time_shift_std_s = 5e-8;     ///< of the gates, the same in all soundings
  double steel_rate = 1e-8;           ///< at 10 us of what steel near by may add, T/s per A m2
  double steel_anisotropy = 0.3;      ///< of its share that changes with the coil's direction

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("ramp_s", self.ramp_s, between(1e-7, 1e-4));
    visit("gate_width", self.gate_width, between(0.01, 0.5));
    visit("model_std", self.model_std, between(1e-4, 1.0));
    visit("gain_std", self.gain_std, between(0.0, 1.0));
    visit("sounding_gain_std", self.sounding_gain_std, between(0.0, 1.0));
    visit("time_shift_std_s", self.time_shift_std_s, between(0.0, 1e-6));
    visit("steel_rate", self.steel_rate, at_least(0.0));
    visit("steel_anisotropy", self.steel_anisotropy, between(0.0, 10.0));
  }
};

/// How well a rock, and a body in it, explain the soundings. What is of no interest enters linearly, has a normal prior and is integrated out in
/// closed form: the gains, the shift of time, and steel: a sum of t^-1/2, t^-1 and t^-2, each with a share that is the same in all directions
/// and one that is a quadratic form of the coil's axis (Rasmussen and Williams, "Gaussian processes for machine learning", 2006, section 2.7).
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
