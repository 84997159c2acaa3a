#include "studies/univariate/growth_model.h"

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/random.h"

namespace patrol::studies {

GrowthModel::GrowthModel(const GrowthModelSettings& settings) : settings_(settings) {
  validate(settings_, "growth_model");
  if (settings_.denominator_sign == 0) throw InputError("growth_model.denominator_sign = 0: must be 1 or -1");
  log_normalizer_ = -0.5 * std::log(2.0 * std::numbers::pi * settings_.observation_var);
}

double GrowthModel::drift(double state) const {
  return 0.5 * state + 25.0 * state / (1.0 + settings_.denominator_sign * state * state);
}

double GrowthModel::forcing(int step) { return 8.0 * std::cos(1.2 * (step - 1)); }

double GrowthModel::mean_observation(double state) { return state * state / 20.0; }

double GrowthModel::log_likelihood(double observation, double state) const {
  const double error = observation - mean_observation(state);
  return log_normalizer_ - 0.5 * error * error / settings_.observation_var;
}

GrowthRun GrowthModel::simulate(std::uint64_t seed) const {
  const RandomStream process(seed, "slam/univariate/process"), sensor(seed, "slam/univariate/sensor");
  const double process_std = std::sqrt(settings_.process_var), sensor_std = std::sqrt(settings_.observation_var);
  GrowthRun run;
  double state = settings_.initial_state;
  for (int step = 1; step <= settings_.steps; ++step) {
    const auto tick = static_cast<std::uint64_t>(step);
    state = transition(state, step) + process_std * process.normal(tick);
    run.states.push_back(state);
    run.observations.push_back(mean_observation(state) + sensor_std * sensor.normal(tick));
  }
  return run;
}

}  // namespace patrol::studies
