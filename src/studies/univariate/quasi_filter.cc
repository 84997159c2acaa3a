#include "studies/univariate/quasi_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <boost/math/special_functions/erf.hpp>

#include "core/particle_weights.h"

namespace patrol::studies {
namespace {

double normal_quantile(double probability) {
  using DoublesStayDoubles = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * probability, DoublesStayDoubles());
}

double square_of(double value) { return value * value; }

}  // namespace

QuasiFilter::QuasiFilter(const QuasiFilterSettings& settings, const GrowthModel& model, std::uint64_t seed)
    : settings_(settings), model_(model), shifts_(seed, "slam/univariate/shifts") {
  validate(settings_, "quasi_filter");
  const auto num = static_cast<std::size_t>(settings_.particles);
  states_.assign(num, model.settings().initial_state);
  log_weights_.assign(num, 0.0);
}

UnivariateEstimate QuasiFilter::step(double observation) {
  constexpr double kGoldenSection = std::numbers::phi - 1.0, kSmallest = 0x1.0p-53;
  ++steps_;
  const std::vector<Branch> branches = make_branches(observation);
  const std::array<double, 4> shifts = shifts_.uniforms(static_cast<std::uint64_t>(steps_));
  const std::size_t num = states_.size();
  std::size_t parent = 0;
  double cumulative = branches.front().weight, second = shifts[1];
  for (std::size_t i = 0; i < num; ++i) {
    const double first = (static_cast<double>(i) + shifts[0]) / static_cast<double>(num);
    while (cumulative < first && parent + 1 < num) cumulative += branches[++parent].weight;
    const Branch& branch = branches[parent];
    states_[i] = branch.proposal_mean + branch.proposal_std * normal_quantile(std::max(second, kSmallest));
    log_weights_[i] = log_weight(branch, states_[i], observation);
    second += kGoldenSection;
    if (second >= 1.0) second -= 1.0;
  }
  weights_ = normalized_weights(log_weights_);
  return summarize(states_, weights_);
}

/// Returns the branches sorted by expected state.
std::vector<QuasiFilter::Branch> QuasiFilter::make_branches(double observation) const {
  const double forcing = GrowthModel::forcing(steps_);
  std::vector<Branch> branches;
  std::vector<double> log_weights;
  branches.reserve(states_.size());
  for (std::size_t i = 0; i < states_.size(); ++i) {
    branches.push_back(make_branch(model_.drift(states_[i]) + forcing, observation));
    log_weights.push_back(log_weights_[i] + branches.back().log_evidence);
  }
  const std::vector<double> weights = normalized_weights(log_weights);
  for (std::size_t i = 0; i < branches.size(); ++i) branches[i].weight = weights[i];
  std::sort(branches.begin(), branches.end(), [](const Branch& a, const Branch& b) { return a.expected < b.expected; });
  return branches;
}

QuasiFilter::Branch QuasiFilter::make_branch(double expected, double observation) const {
  const double Q = model_.settings().process_var, R = model_.settings().observation_var;
  if (!settings_.use_auxiliary) return {.expected = expected, .proposal_mean = expected, .proposal_std = std::sqrt(Q)};
  const double evidence_var = R + square_of(expected / 10.0) * Q + Q * Q / 200.0;
  const double surprise = observation - (expected * expected + Q) / 20.0;
  const auto variance_at = [&](double state) { return 1.0 / (1.0 / Q + square_of(state / 10.0) / R); };
  const double mean =
      expected + variance_at(expected) * expected / 10.0 / R * (observation - GrowthModel::mean_observation(expected));
  return {.expected = expected,
          .proposal_mean = mean,
          .proposal_std = std::sqrt(settings_.proposal_inflation * variance_at(mean)),
          .log_evidence = -0.5 * (surprise * surprise / evidence_var + std::log(evidence_var))};
}

/// Log of p(y | x) p(x | parent) / (q(x) p(y | parent)); without looking ahead, of p(y | x).
double QuasiFilter::log_weight(const Branch& branch, double state, double observation) const {
  const double log_prior = -0.5 * square_of(state - branch.expected) / model_.settings().process_var;
  const double log_proposal =
      -0.5 * square_of((state - branch.proposal_mean) / branch.proposal_std) - std::log(branch.proposal_std);
  return model_.log_likelihood(observation, state) + log_prior - log_proposal - branch.log_evidence;
}

}  // namespace patrol::studies
