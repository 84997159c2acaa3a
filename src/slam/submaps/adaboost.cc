#include "slam/submaps/adaboost.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::slam {
namespace {

constexpr double kChance = 0.5 - 1e-9;  // stumps with larger errors differ from chance only by rounding

using Order = std::vector<std::size_t>;  ///< example indices in ascending order of one feature

void check(const LabeledFeatures& training) {
  if (training.examples.size() != training.labels.size()) {
    throw InputError(fmt::format("adaboost: {} examples and {} labels: numbers must be equal", training.examples.size(),
                                 training.labels.size()));
  }
  for (std::size_t i = 0; i < training.examples.size(); ++i) {
    const std::vector<double>& values = training.examples[i];
    if (values.size() != training.names.size()) {
      throw InputError(
          fmt::format("adaboost: example {}: {} features: must be {}", i, values.size(), training.names.size()));
    }
    for (std::size_t f = 0; f < values.size(); ++f) {
      if (!std::isfinite(values[f]))
        throw InputError(fmt::format("adaboost: example {}: {} = {}: must be finite", i, training.names[f], values[f]));
    }
    if (std::abs(training.labels[i]) != 1)
      throw InputError(fmt::format("adaboost: example {}: label = {}: must be +1 or -1", i, training.labels[i]));
  }
  for (const int label : {1, -1}) {
    if (std::ranges::count(training.labels, label) == 0)
      throw InputError(fmt::format("adaboost: no example has label {}: both labels are required", label));
  }
}

std::vector<Order> sort_by_feature(const LabeledFeatures& training) {
  std::vector<Order> orders(training.names.size());
  for (std::size_t f = 0; f < orders.size(); ++f) {
    orders[f].resize(training.examples.size());
    std::iota(orders[f].begin(), orders[f].end(), std::size_t{0});
    std::ranges::stable_sort(orders[f], {}, [&](std::size_t example) { return training.examples[example][f]; });
  }
  return orders;
}

std::vector<double> first_weights(const std::vector<int>& labels, bool balance_classes) {
  const auto count = static_cast<double>(labels.size());
  const auto positive = static_cast<double>(std::ranges::count(labels, 1));
  std::vector<double> weights;
  for (const int label : labels)
    weights.push_back(!balance_classes ? 1.0 / count : 0.5 / (label > 0 ? positive : count - positive));
  return weights;
}

/// Stump without weight, and its weighted error.
struct StumpCandidate {
  DecisionStump stump;
  double error = 1.0;
};

/// Tries all thresholds in ascending order; `wrong` is the weighted error of the vote "+1 above".
StumpCandidate best_of_feature(std::size_t feature, const Order& order, const LabeledFeatures& training,
                               const std::vector<double>& weights) {
  StumpCandidate best;
  double wrong = 0.0, all = 0.0;
  for (const std::size_t i : order) {
    all += weights[i];
    wrong += training.labels[i] < 0 ? weights[i] : 0.0;
  }
  const auto consider = [&](double threshold) {
    for (const int sign : {1, -1}) {
      const double error = sign > 0 ? wrong / all : 1.0 - wrong / all;
      if (error < best.error)
        best = {.stump = {.feature = feature, .threshold = threshold, .sign_above = sign}, .error = error};
    }
  };
  const auto value = [&](std::size_t rank) { return training.examples[order[rank]][feature]; };
  consider(value(0) - 1.0);
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    wrong += training.labels[order[rank]] > 0 ? weights[order[rank]] : -weights[order[rank]];
    if (rank + 1 == order.size() || value(rank) == value(rank + 1)) continue;
    const double middle = std::midpoint(value(rank), value(rank + 1));
    consider(middle < value(rank + 1) ? middle : value(rank));
  }
  return best;
}

StumpCandidate best_stump(const std::vector<Order>& orders, const LabeledFeatures& training,
                          const std::vector<double>& weights) {
  StumpCandidate best;
  for (std::size_t f = 0; f < orders.size(); ++f) {
    const StumpCandidate candidate = best_of_feature(f, orders[f], training, weights);
    if (candidate.error < best.error) best = candidate;
  }
  return best;
}

bool is_wrong(const DecisionStump& stump, const LabeledFeatures& training, std::size_t example) {
  return stump.vote(training.examples[example]) != training.labels[example];
}

/// Weighted error, summed directly to avoid the cancellation of the incremental sums.
double weighted_error(const DecisionStump& stump, const LabeledFeatures& training, const std::vector<double>& weights) {
  double wrong = 0.0, all = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    all += weights[i];
    wrong += is_wrong(stump, training, i) ? weights[i] : 0.0;
  }
  return wrong / all;
}

/// Scales the weights so that the misclassified examples have half of the total.
void scale_example_weights(const DecisionStump& stump, double error, const LabeledFeatures& training,
                           std::vector<double>& weights) {
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] *= 0.5 / (is_wrong(stump, training, i) ? error : 1.0 - error);
}

double total_weight(const BoostedStumps& model) {
  return std::accumulate(model.stumps.begin(), model.stumps.end(), 0.0,
                         [](double sum, const DecisionStump& stump) { return sum + stump.weight; });
}

double training_error_of(const BoostedStumps& model, const LabeledFeatures& training,
                         const std::vector<double>& weights) {
  double error = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    error += model.margin(training.examples[i]) * training.labels[i] > 0.0 ? 0.0 : weights[i];
  return error;
}

}  // namespace

BoostingResult train_adaboost(const LabeledFeatures& training, const AdaBoostSettings& settings) {
  check(training);
  const std::vector<Order> orders = sort_by_feature(training);
  const std::vector<double> at_start = first_weights(training.labels, settings.balance_classes);
  std::vector<double> weights = at_start;

  BoostingResult result;
  result.model.features = training.names;
  for (int round = 0; round < settings.rounds; ++round) {
    DecisionStump stump = best_stump(orders, training, weights).stump;
    const double error = training.names.empty() ? 1.0 : weighted_error(stump, training, weights);
    if (error >= kChance) break;
    stump.weight = error > 0.0 ? 0.5 * std::log((1.0 - error) / error) : 1.0 + total_weight(result.model);
    result.model.stumps.push_back(stump);
    result.errors.push_back(error);
    result.error_bound *= 2.0 * std::sqrt(error * (1.0 - error));
    if (error == 0.0) break;
    scale_example_weights(stump, error, training, weights);
  }
  result.training_error = training_error_of(result.model, training, at_start);
  return result;
}

}  // namespace patrol::slam
