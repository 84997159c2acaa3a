#include "inspect/water/sounding_likelihood.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/QR>
#include <fmt/format.h>

#include "core/error.h"

namespace patrol::inspect {
namespace {

constexpr std::array kSteelDecay_s = {1e-5, 3e-5, 1e-4, 3e-4};
constexpr double kSteelReferenceTime_s = 1e-5;
constexpr Eigen::Index kForm = 7;  // an isotropic part and the six products of the components of an axis
constexpr Eigen::Index kShape = 4;
constexpr double kReferenceRock_spm = 0.003;  // conductivity to which `tunnel_air_std` and `layer_std` refer

/// Ratios of the response of the tunnel's air to that of the rock, relative to the ratio across the axis at 2 us. Fit
/// to the response of an infinite tunnel of 5.5 m radius in rock of 0.003 S/m: -0.070 along and -0.226 across at 2 us,
/// -0.014 and -0.076 at 10 us.
double air_along(double time_s) { return 0.3 * (2e-6 / time_s); }
double air_across(double time_s) { return std::pow(2e-6 / time_s, 0.7); }

/// Ratio of the response of a layer to that of the rock, relative to its early value: a conductive sheet some 10 m
/// away.
double layer_decay(double time_s) { return 1.0 / std::sqrt(1.0 + time_s / 1e-5); }

TemGateLayout gate_layout(const SoundingErrorSettings& settings, const std::vector<OrientedSounding>& soundings) {
  validate(settings, "stack.inspection.water.errors");
  if (soundings.empty()) throw InputError("water soundings: none given: must be at least one");
  const std::vector<double>& gate_s = soundings.front().sounding.gate_s;
  for (const OrientedSounding& oriented : soundings) {
    const TemSounding& sounding = oriented.sounding;
    if (sounding.gate_s != gate_s || sounding.rate_tps.size() != gate_s.size() ||
        sounding.std_tps.size() != gate_s.size() || gate_s.size() < 3 || !(sounding.moment_am2 > 0.0)) {
      throw InputError(
          fmt::format("water sounding at {:.3f} s: gates differ from those of the first sounding: must be equal",
                      to_seconds(sounding.stamp)));
    }
  }
  return {.gate_s = gate_s, .ramp_s = settings.ramp_s, .gate_width = settings.gate_width};
}

/// Returns the six products of the components of an axis that span the quadratic forms.
Eigen::Matrix<double, 6, 1> products(const Eigen::Vector3d& a) {
  return {a.x() * a.x(), a.y() * a.y(), a.z() * a.z(), 2.0 * a.x() * a.y(), 2.0 * a.x() * a.z(), 2.0 * a.y() * a.z()};
}

/// Returns soundings with reduced noise: per gate the best-fitting quadratic form of the axis, or zero if it is not
/// significant. Errors proportional to the signal must be scaled with this estimate and not with the readings.
/// Otherwise a gain that shrinks all readings would shrink their errors too and become more likely (Peelle's puzzle
/// [DAgostini94]). `rate`, `std`: [gate][sounding].
Eigen::MatrixXd fit_quadratic_form(const Eigen::MatrixXd& rate, const Eigen::MatrixXd& std,
                                   const std::vector<Eigen::Vector3d>& axes) {
  constexpr Eigen::Index kEnough = 12;
  const Eigen::Index count = rate.cols();
  Eigen::MatrixXd form = Eigen::MatrixXd::Ones(count, count < kEnough ? 1 : 6);
  for (Eigen::Index i = 0; i < count && count >= kEnough; ++i)
    form.row(i) = products(axes[static_cast<std::size_t>(i)]).transpose();
  const Eigen::MatrixXd fit = form.completeOrthogonalDecomposition().solve(rate.transpose());
  Eigen::MatrixXd smooth = (form * fit).transpose();
  constexpr double kClear = 3.0;
  for (Eigen::Index gate = 0; gate < rate.rows(); ++gate) {
    if (smooth.row(gate).norm() < kClear * std.row(gate).norm()) smooth.row(gate).setZero();
  }
  return smooth;
}

/// Returns d ln(rate) / dt of the mean over the soundings, [gate], 1/s. Gates without significant neighbors use that of
/// rock.
Eigen::VectorXd log_slopes(const std::vector<double>& gate_s, const Eigen::VectorXd& mean) {
  const auto gates = static_cast<Eigen::Index>(gate_s.size());
  Eigen::VectorXd slopes(gates);
  for (Eigen::Index gate = 0; gate < gates; ++gate) {
    const Eigen::Index before = std::max<Eigen::Index>(gate - 1, 0), after = std::min(gate + 1, gates - 1);
    const double dt_s = gate_s[static_cast<std::size_t>(after)] - gate_s[static_cast<std::size_t>(before)];
    const bool is_clear = mean[before] > 0.0 && mean[after] > 0.0;
    slopes[gate] =
        is_clear ? std::log(mean[after] / mean[before]) / dt_s : -2.5 / gate_s[static_cast<std::size_t>(gate)];
  }
  return slopes;
}

}  // namespace

SoundingLikelihood::SoundingLikelihood(const SoundingErrorSettings& settings,
                                       const std::vector<OrientedSounding>& soundings)
    : gates_(gate_layout(settings, soundings)),
      gate_s_(soundings.front().sounding.gate_s),
      num_gates_(static_cast<Eigen::Index>(gate_s_.size())),
      body_shape_std_(settings.body_shape_std) {
  const auto count = static_cast<Eigen::Index>(soundings.size());
  Eigen::MatrixXd rate(num_gates_, count), std(num_gates_, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const OrientedSounding& oriented = soundings[static_cast<std::size_t>(i)];
    axes_.push_back(quaternion_from_rpy(0.0, oriented.pose.pitch_rad, oriented.pose.yaw_rad) *
                    Eigen::Vector3d::UnitX());
    for (Eigen::Index gate = 0; gate < num_gates_; ++gate) {
      const auto g = static_cast<std::size_t>(gate);
      rate(gate, i) = oriented.sounding.rate_tps[g] / oriented.sounding.moment_am2;
      std(gate, i) = oriented.sounding.std_tps[g] / oriented.sounding.moment_am2;
      if (!std::isfinite(rate(gate, i)) || !(std(gate, i) > 0.0)) {
        throw InputError(fmt::format(
            "water sounding at {:.3f} s: gate {} is invalid: must be finite with a positive standard deviation",
            to_seconds(oriented.sounding.stamp), gate));
      }
    }
  }
  const Eigen::MatrixXd smooth = fit_quadratic_form(rate, std, axes_);
  const Eigen::VectorXd mean = smooth.rowwise().mean(), slopes = log_slopes(gate_s_, mean);
  std = (std.array().square() + (settings.model_std * smooth.array()).square()).sqrt();

  const Eigen::Index common = 2 + kForm * static_cast<Eigen::Index>(kSteelDecay_s.size());
  const Eigen::Index data = num_gates_ * count;
  data_.resize(data);
  inverse_std_.resize(data);
  nuisances_ = Eigen::MatrixXd::Zero(data, common + count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index gate = 0; gate < num_gates_; ++gate) {
      const Eigen::Index row = i * num_gates_ + gate;
      const double time_s = gate_s_[static_cast<std::size_t>(gate)], signal = smooth(gate, i) / std(gate, i);
      inverse_std_[row] = 1.0 / std(gate, i);
      data_[row] = rate(gate, i) / std(gate, i);
      nuisances_(row, 0) = settings.gain_std * signal;
      nuisances_(row, 1) = settings.time_shift_std_s * slopes[gate] * signal;
      nuisances_(row, common + i) = settings.sounding_gain_std * signal;
      Eigen::Index column = 2;
      const auto add_form = [&](double isotropic, double anisotropy) {
        nuisances_(row, column) = isotropic;
        nuisances_.block<1, 6>(row, column + 1) =
            anisotropy * isotropic * products(axes_[static_cast<std::size_t>(i)]).transpose();
        column += kForm;
      };
      for (const double decay_s : kSteelDecay_s) {
        add_form(settings.steel_response * std::exp((kSteelReferenceTime_s - time_s) / decay_s) * inverse_std_[row],
                 settings.steel_anisotropy);
      }
    }
  }
  set_ground_deviations(settings);
  const Eigen::Index columns = nuisances_.cols();
  nuisance_information_.compute(Eigen::MatrixXd::Identity(columns, columns) + nuisances_.transpose() * nuisances_);
}

/// Sets the deviations of the response of the ground from that of homogeneous rock, for rock of unit conductivity. The
/// tunnel's axis is the x axis of the mount.
void SoundingLikelihood::set_ground_deviations(const SoundingErrorSettings& settings) {
  const Eigen::VectorXd rock = gated_whole_space_response(gates_, 1.0);
  const Eigen::Index num_air = settings.tunnel_air_std > 0.0 ? 2 : 0, num_layer = settings.layer_std > 0.0 ? kForm : 0;
  air_ = Eigen::MatrixXd::Zero(data_.size(), num_air);
  layer_ = Eigen::MatrixXd::Zero(data_.size(), num_layer);
  for (Eigen::Index row = 0; row < data_.size(); ++row) {
    const Eigen::Index gate = row % num_gates_;
    const Eigen::Vector3d& axis = axes_[static_cast<std::size_t>(row / num_gates_)];
    const double time_s = gate_s_[static_cast<std::size_t>(gate)], cosine_squared = axis.x() * axis.x();
    const double scale = rock[gate] * inverse_std_[row];
    if (num_air > 0) {
      air_(row, 0) = settings.tunnel_air_std * air_along(time_s) * cosine_squared * scale;
      air_(row, 1) = settings.tunnel_air_std * air_across(time_s) * (1.0 - cosine_squared) * scale;
    }
    if (num_layer > 0) {
      layer_(row, 0) = settings.layer_std * layer_decay(time_s) * scale;
      layer_.block<1, 6>(row, 1) = layer_(row, 0) * products(axis).transpose();
    }
  }
}

/// Returns the deviations of the ground's response for a conductivity of the rock, whitened, followed by `num_others`
/// columns of zeros, [datum][deviation]. The response of rock is proportional to the power 3/2 of its conductivity.
/// That of the air, relative to it, is proportional to the conductivity; that of a layer is inversely proportional.
Eigen::MatrixXd SoundingLikelihood::deviations(double rock_spm, Eigen::Index num_others) const {
  const double rock = rock_spm * std::sqrt(rock_spm), ratio = rock_spm / kReferenceRock_spm;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(data_.size(), air_.cols() + layer_.cols() + num_others);
  all.leftCols(air_.cols()) = (rock * ratio) * air_;
  all.middleCols(air_.cols(), layer_.cols()) = (rock / ratio) * layer_;
  return all;
}

// With residual r and nuisances B, both whitened: r' (I + B B')^-1 r = r'r - (B'r)' (I + B'B)^-1 (B'r).
double SoundingLikelihood::log_likelihood_residual(const Eigen::VectorXd& whitened) const {
  const Eigen::VectorXd projected = nuisances_.transpose() * whitened;
  return -0.5 * (whitened.squaredNorm() - projected.dot(nuisance_information_.solve(projected)));
}

// The deviations C of the model, whitened with unit prior standard deviation, depend on the parameters: with M = (I + B
// B')^-1 and G = C'M C, r' (I + B B' + C C')^-1 r = r'M r - (C'M r)' (I + G)^-1 (C'M r), and the determinant grows by
// that of I + G.
double SoundingLikelihood::log_likelihood_residual(const Eigen::VectorXd& whitened,
                                                   const Eigen::MatrixXd& deviations) const {
  if (deviations.cols() == 0) return log_likelihood_residual(whitened);
  const Eigen::MatrixXd projected_deviations = nuisances_.transpose() * deviations,
                        solved = nuisance_information_.solve(projected_deviations);
  const Eigen::MatrixXd information = Eigen::MatrixXd::Identity(deviations.cols(), deviations.cols()) +
                                      deviations.transpose() * deviations - projected_deviations.transpose() * solved;
  const Eigen::VectorXd projected =
      deviations.transpose() * whitened - solved.transpose() * (nuisances_.transpose() * whitened);
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  return log_likelihood_residual(whitened) + 0.5 * (projected.dot(factor.solve(projected)) - log_determinant);
}

/// Returns the deviations of a body's response from that of a sphere, whitened, [datum][deviation]: along and across
/// the line of sight, and the two mixed terms of a body whose axes are oblique. A moment of 1 along the line of sight
/// responds like 4 along, 1 across and 2 mixed.
Eigen::MatrixXd SoundingLikelihood::shape_deviations(const GatedSphereResponse& body,
                                                     const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d aside = direction.unitOrthogonal(), other = direction.cross(aside);
  Eigen::MatrixXd shape(data_.size(), kShape);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Eigen::Index row = static_cast<Eigen::Index>(i) * num_gates_;
    const double cosine = axes_[i].dot(direction);
    const auto scale = inverse_std_.segment(row, num_gates_);
    const Eigen::VectorXd axial = body_shape_std_ * body.axial.cwiseProduct(scale);
    shape.col(0).segment(row, num_gates_) = cosine * cosine * axial;
    shape.col(1).segment(row, num_gates_) =
        body_shape_std_ * (1.0 - cosine * cosine) * body.transverse.cwiseProduct(scale);
    shape.col(2).segment(row, num_gates_) = cosine * axes_[i].dot(aside) * axial;
    shape.col(3).segment(row, num_gates_) = cosine * axes_[i].dot(other) * axial;
  }
  return shape;
}

double SoundingLikelihood::log_likelihood_rock(double rock_spm) const {
  const Eigen::VectorXd rock = gated_whole_space_response(gates_, rock_spm);
  return log_likelihood_residual(
      data_ - rock.replicate(static_cast<Eigen::Index>(axes_.size()), 1).cwiseProduct(inverse_std_),
      deviations(rock_spm, 0));
}

double SoundingLikelihood::log_likelihood_body(double rock_spm, const ConductiveSphere& sphere,
                                               const Eigen::Vector3d& direction) const {
  const GatedSphereResponse body = gated_sphere_response(gates_, rock_spm, sphere);
  const Eigen::VectorXd across = gated_whole_space_response(gates_, rock_spm) + body.transverse,
                        along = body.axial - body.transverse;
  Eigen::VectorXd whitened = data_;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Eigen::Index row = static_cast<Eigen::Index>(i) * num_gates_;
    const double cosine = axes_[i].dot(direction);
    whitened.segment(row, num_gates_) -=
        (across + cosine * cosine * along).cwiseProduct(inverse_std_.segment(row, num_gates_));
  }
  const Eigen::Index num_shape = body_shape_std_ > 0.0 ? kShape : 0;
  Eigen::MatrixXd all = deviations(rock_spm, num_shape);
  if (num_shape > 0) all.rightCols(num_shape) = shape_deviations(body, direction);
  return log_likelihood_residual(whitened, all);
}

}  // namespace patrol::inspect
