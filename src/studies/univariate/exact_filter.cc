#include "studies/univariate/exact_filter.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/particle_weights.h"

namespace patrol::studies {
namespace {

constexpr double kCutoffSigmas = 8.0;       // standard deviations of the process noise; exp(-8^2 / 2) = 1e-14
constexpr double kMinMassFraction = 1e-18;  // of the maximum mass; smaller masses are not propagated

}  // namespace

ExactFilter::ExactFilter(const GrowthModel& model, const ExactFilterSettings& settings)
    : model_(model), cell_(settings.cell) {
  validate(settings, "exact_filter");
  if (model.settings().denominator_sign < 0) {
    throw InputError("growth_model.denominator_sign = -1: must be 1 for the exact filter");
  }
  const int half = static_cast<int>(std::ceil(settings.half_width / cell_));
  for (int i = -half; i <= half; ++i) nodes_.push_back(i * cell_);
  const double process_var = model.settings().process_var;
  const int reach = static_cast<int>(std::ceil(kCutoffSigmas * std::sqrt(process_var) / cell_));
  for (int k = 0; k <= reach; ++k) bell_.push_back(std::exp(-0.5 * k * k * cell_ * cell_ / process_var));
}

// With the mean at distance d from a node, the density k nodes from there is exp(-d^2 / 2 Q) exp(-k^2 cell^2 / 2 Q)
// exp(d cell / Q)^k. This form needs no exponential in the loop. `predicted` has a margin of the kernel size at both
// ends.
void ExactFilter::spread(double mean, double mass, std::vector<double>& predicted) const {
  const double process_var = model_.settings().process_var;
  const double position_in_nodes = (mean - nodes_.front()) / cell_;
  if (position_in_nodes < 0.0 || position_in_nodes > static_cast<double>(nodes_.size() - 1)) return;
  const auto nearest = static_cast<std::size_t>(std::lround(position_in_nodes));
  const double ahead = (position_in_nodes - static_cast<double>(nearest)) * cell_;
  const double up_ratio = std::exp(ahead * cell_ / process_var), down_ratio = 1.0 / up_ratio;
  double up = mass * std::exp(-0.5 * ahead * ahead / process_var), down = up;
  const std::size_t middle = nearest + bell_.size();
  predicted[middle] += up;
  for (std::size_t k = 1; k < bell_.size(); ++k) {
    up *= up_ratio, down *= down_ratio;
    predicted[middle + k] += up * bell_[k];
    predicted[middle - k] += down * bell_[k];
  }
}

std::vector<double> ExactFilter::predict() const {
  const double forcing = GrowthModel::forcing(steps_);
  std::vector<double> predicted(nodes_.size() + 2 * bell_.size(), 0.0);
  if (density_.empty()) {
    spread(model_.drift(model_.settings().initial_state) + forcing, 1.0, predicted);
  } else {
    const double smallest = kMinMassFraction * *std::max_element(density_.begin(), density_.end());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (density_[i] > smallest) spread(model_.drift(nodes_[i]) + forcing, density_[i], predicted);
    }
  }
  const auto first = predicted.begin() + static_cast<std::ptrdiff_t>(bell_.size());
  return {first, first + static_cast<std::ptrdiff_t>(nodes_.size())};
}

UnivariateEstimate ExactFilter::step(double observation) {
  ++steps_;
  std::vector<double> log_density = predict();
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    log_density[i] = std::log(log_density[i]) + model_.log_likelihood(observation, nodes_[i]);
  density_ = normalized_weights(log_density);
  UnivariateEstimate estimate = summarize(nodes_, density_);
  estimate.effective_sample_size = 0.0;
  for (double& value : density_) value /= cell_;
  return estimate;
}

}  // namespace patrol::studies
