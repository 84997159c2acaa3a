#include "inspect/water/sounding_likelihood.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "core/error.h"

namespace patrol::inspect {
namespace {

using Form = Eigen::Matrix<double, 6, 1>;  ///< coefficients of a quadratic form of the axis with respect to `products`

constexpr std::array kSteelDecay_s = {1e-5, 3e-5, 1e-4, 3e-4};
constexpr double kSteelReferenceTime_s = 1e-5;
constexpr Eigen::Index kProducts = 6;          // products of the components of an axis
constexpr Eigen::Index kForm = 1 + kProducts;  // with an isotropic part
constexpr Eigen::Index kShape = 4, kAir = 2;
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
Form products(const Eigen::Vector3d& a) {
  return {a.x() * a.x(), a.y() * a.y(), a.z() * a.z(), 2.0 * a.x() * a.y(), 2.0 * a.x() * a.z(), 2.0 * a.y() * a.z()};
}

/// Form that is 1 for all axes.
const Form kIsotropic{1.0, 1.0, 1.0, 0.0, 0.0, 0.0};

/// Returns the form (a d) (a e) of the axis a.
Form product_form(const Eigen::Vector3d& d, const Eigen::Vector3d& e) {
  return {d.x() * e.x(),
          d.y() * e.y(),
          d.z() * e.z(),
          0.5 * (d.x() * e.y() + d.y() * e.x()),
          0.5 * (d.x() * e.z() + d.z() * e.x()),
          0.5 * (d.y() * e.z() + d.z() * e.y())};
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
  const Eigen::MatrixXd fit = (form.transpose() * form).ldlt().solve(form.transpose() * rate.transpose());
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
      num_layer_(settings.layer_std > 0.0 ? kForm : 0),
      body_shape_std_(settings.body_shape_std) {
  const auto count = static_cast<Eigen::Index>(soundings.size());
  std::vector<Eigen::Vector3d> axes;
  Eigen::MatrixXd rate(num_gates_, count), std(num_gates_, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const OrientedSounding& oriented = soundings[static_cast<std::size_t>(i)];
    axes.push_back(quaternion_from_rpy(0.0, oriented.pose.pitch_rad, oriented.pose.yaw_rad) * Eigen::Vector3d::UnitX());
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
  const Eigen::MatrixXd smooth = fit_quadratic_form(rate, std, axes);
  const Eigen::VectorXd mean = smooth.rowwise().mean(), slopes = log_slopes(gate_s_, mean);
  std = (std.array().square() + (settings.model_std * smooth.array()).square()).sqrt();

  const Eigen::Index common = 2 + kForm * static_cast<Eigen::Index>(kSteelDecay_s.size());
  const Eigen::Index data = num_gates_ * count;
  Eigen::VectorXd whitened(data), inverse_std(data);
  Eigen::MatrixXd nuisances = Eigen::MatrixXd::Zero(data, common + count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index gate = 0; gate < num_gates_; ++gate) {
      const Eigen::Index row = i * num_gates_ + gate;
      const double time_s = gate_s_[static_cast<std::size_t>(gate)], signal = smooth(gate, i) / std(gate, i);
      inverse_std[row] = 1.0 / std(gate, i);
      whitened[row] = rate(gate, i) / std(gate, i);
      nuisances(row, 0) = settings.gain_std * signal;
      nuisances(row, 1) = settings.time_shift_std_s * slopes[gate] * signal;
      nuisances(row, common + i) = settings.sounding_gain_std * signal;
      Eigen::Index column = 2;
      const auto add_form = [&](double isotropic, double anisotropy) {
        nuisances(row, column) = isotropic;
        nuisances.block<1, 6>(row, column + 1) =
            anisotropy * isotropic * products(axes[static_cast<std::size_t>(i)]).transpose();
        column += kForm;
      };
      for (const double decay_s : kSteelDecay_s) {
        add_form(settings.steel_response * std::exp((kSteelReferenceTime_s - time_s) / decay_s) * inverse_std[row],
                 settings.steel_anisotropy);
      }
    }
  }
  set_gram(nuisances, model_columns(settings, axes, inverse_std, whitened));
}

/// Returns the whitened columns that models and data consist of, [datum][column]: per product of the components of the
/// axis and gate, a response of 1; the deviations of the ground's response by the tunnel's air and by layers; rock; the
/// data. The ground is of unit conductivity. The tunnel's axis is the x axis of the mount.
Eigen::MatrixXd SoundingLikelihood::model_columns(const SoundingErrorSettings& settings,
                                                  const std::vector<Eigen::Vector3d>& axes,
                                                  const Eigen::VectorXd& inverse_std,
                                                  const Eigen::VectorXd& data) const {
  const Eigen::VectorXd rock = gated_whole_space_response(gates_, 1.0);
  const Eigen::Index air = kProducts * num_gates_, layer = air + kAir;
  Eigen::MatrixXd columns(data.size(), layer + num_layer_ + 2);
  columns.setZero();
  for (Eigen::Index row = 0; row < data.size(); ++row) {
    const Eigen::Index gate = row % num_gates_;
    const Eigen::Vector3d& axis = axes[static_cast<std::size_t>(row / num_gates_)];
    const double time_s = gate_s_[static_cast<std::size_t>(gate)], cosine_squared = axis.x() * axis.x();
    const double scale = rock[gate] * inverse_std[row];
    const Form form = products(axis);
    for (Eigen::Index product = 0; product < kProducts; ++product)
      columns(row, product * num_gates_ + gate) = form[product] * inverse_std[row];
    columns(row, air) = settings.tunnel_air_std * air_along(time_s) * cosine_squared * scale;
    columns(row, air + 1) = settings.tunnel_air_std * air_across(time_s) * (1.0 - cosine_squared) * scale;
    if (num_layer_ > 0) {
      columns(row, layer) = settings.layer_std * layer_decay(time_s) * scale;
      columns.block<1, kProducts>(row, layer + 1) = columns(row, layer) * form.transpose();
    }
    columns(row, layer + num_layer_) = scale;
    columns(row, layer + num_layer_ + 1) = data[row];
  }
  return columns;
}

// With columns X and nuisances B, both whitened: X' (I + B B')^-1 X = X'X - (B'X)' (I + B'B)^-1 (B'X).
void SoundingLikelihood::set_gram(const Eigen::MatrixXd& nuisances, const Eigen::MatrixXd& columns) {
  const Eigen::Index count = nuisances.cols();
  const Eigen::LLT<Eigen::MatrixXd> information(Eigen::MatrixXd::Identity(count, count) +
                                                nuisances.transpose() * nuisances);
  const Eigen::MatrixXd projected = nuisances.transpose() * columns;
  gram_ = columns.transpose() * columns - projected.transpose() * information.solve(projected);
}

/// Returns the Gram matrix of the terms of a body's response, followed by the columns from the air on. The terms: along
/// and across the line of sight, and the two mixed terms of a body whose axes are oblique. A moment of 1 along the line
/// of sight responds like 4 along, 1 across and 2 mixed; the mixed terms have the profile of that along.
SoundingLikelihood::Gram SoundingLikelihood::body_gram(const GatedSphereResponse& body,
                                                       const Eigen::Vector3d& direction) const {
  const Eigen::Index responses = kProducts * num_gates_, others = gram_.cols() - responses;
  Eigen::Matrix<double, Eigen::Dynamic, 2> profiles(num_gates_, 2), product(responses, 2);
  profiles << body.axial, body.transverse;
  // Row 2 f + p: profile p of the body times product f of the components of the axis.
  Eigen::Matrix<double, 2 * kProducts, 2 * kProducts> gram;
  Eigen::Matrix<double, 2 * kProducts, Eigen::Dynamic, 0, 2 * kProducts, kMaxColumns> gram_others(2 * kProducts,
                                                                                                  others);
  for (Eigen::Index f = 0; f < kProducts; ++f) {
    const Eigen::Index first = f * num_gates_, rows = responses - first;
    // Per column: Eigen would copy the matrix for a product of matrices.
    for (Eigen::Index p = 0; p < 2; ++p)
      product.col(p).head(rows).noalias() = gram_.block(first, first, rows, num_gates_) * profiles.col(p);
    for (Eigen::Index e = f; e < kProducts; ++e) {
      gram.block<2, 2>(2 * e, 2 * f) = profiles.transpose() * product.middleRows((e - f) * num_gates_, num_gates_);
      gram.block<2, 2>(2 * f, 2 * e) = gram.block<2, 2>(2 * e, 2 * f).transpose().eval();
    }
    gram_others.middleRows<2>(2 * f) = profiles.transpose() * gram_.block(first, responses, num_gates_, others);
  }
  const Eigen::Vector3d aside = direction.unitOrthogonal(), other = direction.cross(aside);
  const Form along = product_form(direction, direction), mixed = product_form(direction, aside),
             other_mixed = product_form(direction, other);
  Eigen::Matrix<double, 2 * kProducts, kShape> terms = Eigen::Matrix<double, 2 * kProducts, kShape>::Zero();
  for (Eigen::Index f = 0; f < kProducts; ++f) {
    terms(2 * f, 0) = along[f];
    terms(2 * f + 1, 1) = kIsotropic[f] - along[f];
    terms(2 * f, 2) = mixed[f];
    terms(2 * f, 3) = other_mixed[f];
  }
  Gram all(kShape + others, kShape + others);
  all.topLeftCorner<kShape, kShape>() = terms.transpose() * gram * terms;
  all.topRightCorner(kShape, others) = terms.transpose() * gram_others;
  all.bottomLeftCorner(others, kShape) = all.topRightCorner(kShape, others).transpose();
  all.bottomRightCorner(others, others) = gram_.bottomRightCorner(others, others);
  return all;
}

/// Returns the log likelihood for the Gram matrix of the deviations of the model, rock, and data. The first `num_shape`
/// deviations are the terms of a body. The response of rock is proportional to the power 3/2 of its conductivity. That
/// of the air, relative to it, is proportional to the conductivity; that of a layer is inversely proportional.
///
/// The deviations C of the model have unit prior standard deviation. With nuisances B, M = (I + B B')^-1 and G = C'M C,
/// r' (I + B B' + C C')^-1 r = r'M r - (C'M r)' (I + G)^-1 (C'M r), and the determinant grows by that of I + G.
double SoundingLikelihood::log_likelihood(double rock_spm, const Gram& gram, Eigen::Index num_shape) const {
  const double rock = rock_spm * std::sqrt(rock_spm), ratio = rock_spm / kReferenceRock_spm;
  const Eigen::Index columns = gram.cols(), count = columns - 2;
  Column residual = Column::Zero(columns), scale(count);
  residual.head(std::min<Eigen::Index>(num_shape, 2)).setConstant(-1.0);  // a sphere: along and across
  residual[count] = -rock;
  residual[count + 1] = 1.0;
  scale << Column::Constant(num_shape, body_shape_std_), Column::Constant(kAir, rock * ratio),
      Column::Constant(num_layer_, rock / ratio);
  const Column product = gram * residual, projected = scale.cwiseProduct(product.head(count));
  Gram information = scale.asDiagonal() * gram.topLeftCorner(count, count) * scale.asDiagonal();
  information.diagonal().array() += 1.0;
  const Eigen::LLT<Gram> factor(information);
  const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  return -0.5 * (residual.dot(product) - projected.dot(factor.solve(projected)) + log_determinant);
}

double SoundingLikelihood::log_likelihood_rock(double rock_spm) const {
  const Eigen::Index columns = kAir + num_layer_ + 2;
  return log_likelihood(rock_spm, gram_.bottomRightCorner(columns, columns), 0);
}

double SoundingLikelihood::log_likelihood_body(double rock_spm, const ConductiveSphere& sphere,
                                               const Eigen::Vector3d& direction) const {
  return log_likelihood(rock_spm, body_gram(gated_sphere_response(gates_, rock_spm, sphere), direction), kShape);
}

}  // namespace patrol::inspect
