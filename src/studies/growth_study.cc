#include "studies/growth_study.h"

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/thread_cpu_time.h"
#include "report/boxes.h"
#include "studies/univariate/exact_filter.h"
#include "studies/univariate/growth_filter.h"
#include "studies/univariate/quasi_filter.h"

namespace patrol::studies {
namespace {

using report::SeriesColor;

constexpr double kNoGrowthMetric = std::numeric_limits<double>::quiet_NaN();

/// Filter in the study.
struct GrowthMethod {
  std::string name;
  int particles = 0;  ///< 0: the exact filter
  std::vector<std::optional<double>> published{};
  std::function<std::unique_ptr<UnivariateFilter>(const GrowthModel& model, std::uint64_t seed)> make;
};

GrowthMethod particle_filter(const std::string& name, int particles, const slam::ParticleFilterSettings& settings,
                             std::optional<double> published = {}) {
  return {.name = name,
          .particles = particles,
          .published = {published},
          .make = [=](const GrowthModel& model, std::uint64_t seed) {
            return std::make_unique<GrowthFilter>(particles, model, slam::make_components(settings), seed);
          }};
}

/// Settings of the publication with unbiased resampling at every step (gamma = 1). One generation per step has about
/// the computation time that the publication states.
slam::ParticleFilterSettings published_settings(const std::string& optimizer) {
  slam::ParticleFilterSettings settings = published_ifa_settings();
  settings.optimizer = optimizer;
  settings.resampler = "systematic";
  return settings;
}

std::vector<GrowthMethod> methods_of(int particles, const std::array<double, 4>& published) {
  return {particle_filter("PF", particles, published_settings("none"), published[0]),
          particle_filter("BA", particles, published_settings("ba"), published[1]),
          particle_filter("FA", particles, published_settings("fa"), published[2]),
          particle_filter("IFA", particles, published_ifa_settings(), published[3]),
          particle_filter("IFA, unbiased resampling", particles, published_settings("ifa")),
          {.name = "quasi-Monte Carlo (this work)",
           .particles = particles,
           .make = [=](const GrowthModel& model, std::uint64_t seed) {
             return std::make_unique<QuasiFilter>(QuasiFilterSettings{.particles = particles}, model, seed);
           }}};
}

/// Sign of eq. 9 with the filters of its trial; they are compared with the first one if it is the exact filter.
struct GrowthTrial {
  std::string world;
  GrowthModel model;
  std::vector<GrowthMethod> methods;
};

std::vector<GrowthTrial> growth_trials() {
  std::vector<GrowthTrial> trials = {
      {.world = "1 + x² in the denominator", .model = GrowthModel(), .methods = {}},
      {.world = "1 − x², as eq. 9 prints it", .model = GrowthModel({.denominator_sign = -1}), .methods = {}}};
  trials[0].methods.push_back(
      {.name = "exact Bayes filter (the bound)",
       .make = [](const GrowthModel& model, std::uint64_t) { return std::make_unique<ExactFilter>(model); }});
  const std::array<std::pair<int, std::array<double, 4>>, 3> table_1 = {{{50, {4.2216, 3.6631, 3.2270, 2.9783}},
                                                                         {100, {3.0043, 2.5799, 2.4075, 1.8843}},
                                                                         {150, {2.4415, 1.8336, 1.6815, 1.2885}}}};
  for (const auto& [particles, published] : table_1) {
    for (const GrowthMethod& method : methods_of(particles, published)) trials[0].methods.push_back(method);
  }
  trials[1].methods = {particle_filter("PF", 100, published_settings("none")),
                       particle_filter("IFA", 100, published_ifa_settings())};
  return trials;
}

struct GrowthTrack {
  std::vector<UnivariateEstimate> estimates;  ///< [step]
  double seconds = 0.0;
};

GrowthTrack follow(UnivariateFilter& filter, const GrowthRun& run) {
  GrowthTrack track;
  const double start_s = thread_cpu_time_s();
  for (const double observation : run.observations) track.estimates.push_back(filter.step(observation));
  track.seconds = thread_cpu_time_s() - start_s;
  return track;
}

std::vector<double> flatten_metrics(const GrowthMethod& method, const GrowthTrack& track, const GrowthRun& run) {
  double squares = 0.0, nees = 0.0, num_effective = 0.0;
  for (std::size_t t = 0; t < run.states.size(); ++t) {
    const UnivariateEstimate& estimate = track.estimates[t];
    const double square = (estimate.mean - run.states[t]) * (estimate.mean - run.states[t]);
    squares += square;
    nees += square / (estimate.variance + 1e-6);
    num_effective += estimate.effective_sample_size;
  }
  const auto steps = static_cast<double>(run.states.size());
  return {std::sqrt(squares / steps), nees / steps, method.particles > 0 ? num_effective / steps : kNoGrowthMetric,
          1e3 * track.seconds};
}

StudySample run_growth_trials(const std::vector<GrowthTrial>& trials, std::uint64_t seed) {
  StudySample sample;
  for (const GrowthTrial& trial : trials) {
    const GrowthRun run = trial.model.simulate(seed);
    for (const GrowthMethod& method : trial.methods) {
      const auto filter = method.make(trial.model, seed);
      sample.push_back(flatten_metrics(method, follow(*filter, run), run));
    }
  }
  return sample;
}

std::vector<StudyVariant> growth_variants(const std::vector<GrowthTrial>& trials) {
  std::vector<StudyVariant> variants;
  for (const GrowthTrial& trial : trials) {
    const std::size_t first = variants.size();
    const bool has_bound = trial.methods.front().particles == 0;
    for (const GrowthMethod& method : trial.methods) {
      const std::size_t reference = has_bound ? first : variants.size();
      variants.push_back({.world = trial.world,
                          .method = method.name,
                          .particles = method.particles,
                          .reference = reference,
                          .published = method.published});
    }
  }
  return variants;
}

report::Curve curve_of(const std::string& name, SeriesColor color, const std::vector<double>& values) {
  report::Curve curve{.name = name, .color = color, .is_dashed = false, .points = {}};
  for (std::size_t t = 0; t < values.size(); ++t) curve.points.emplace_back(static_cast<double>(t + 1), values[t]);
  return curve;
}

/// Figures 1 to 4: states and errors over time, and the particles at step 25; N = 100.
std::vector<report::Section> illustrate_growth(const GrowthTrial& trial, std::uint64_t seed) {
  constexpr int kParticles = 100, kShownStep = 25;
  constexpr std::array kColors = {SeriesColor::kOdometry, SeriesColor::kRanges, SeriesColor::kConfidence,
                                  SeriesColor::kAlarm,    SeriesColor::kEvent,  SeriesColor::kEstimate};
  const GrowthRun run = trial.model.simulate(seed);
  const report::PlotAxis axis = {.label = "step", .max = static_cast<double>(run.states.size())};
  report::LinePlot states{.title = fmt::format("State, seed {}, N = {}", seed, kParticles),
                          .unit = "",
                          .axis = axis,
                          .max = {},
                          .curves = {},
                          .marks = {},
                          .spans = {}};
  report::LinePlot errors{
      .title = "Absolute error", .unit = "", .axis = axis, .max = {}, .curves = {}, .marks = {}, .spans = {}};
  report::BoxPlot spread{
      .caption = fmt::format("Particles at step {}; the true state is {:.2f}", kShownStep, run.states[kShownStep - 1]),
      .unit = "",
      .boxes = {}};
  states.curves.push_back(curve_of("true state", SeriesColor::kTruth, run.states));
  std::size_t num_shown = 0;
  for (const GrowthMethod& method : trial.methods) {
    if (method.particles != kParticles && method.particles != 0) continue;
    const auto filter = method.make(trial.model, seed);
    std::vector<double> means, sizes, particles;
    for (std::size_t t = 0; t < run.states.size(); ++t) {
      means.push_back(filter->step(run.observations[t]).mean);
      sizes.push_back(std::abs(means.back() - run.states[t]));
      if (t + 1 != kShownStep) continue;
      if (const auto* growth = dynamic_cast<const GrowthFilter*>(filter.get())) particles = growth->states();
      if (const auto* quasi = dynamic_cast<const QuasiFilter*>(filter.get())) particles = quasi->states();
    }
    const SeriesColor color = method.particles == 0 ? SeriesColor::kBound : kColors[num_shown++ % kColors.size()];
    states.curves.push_back(curve_of(method.name, color, means));
    errors.curves.push_back(curve_of(method.name, color, sizes));
    if (!particles.empty()) spread.boxes.push_back(report::box_of(method.name, particles, {}));
  }
  return {{"States and errors over time", {states, errors}}, {"Spread of the particles", {spread}}};
}

}  // namespace

Study growth_study() {
  std::vector<GrowthTrial> trials = growth_trials();
  Study study{
      .name = "ungm",
      .title = "Particle filters on the univariate growth model",
      .source = "[Cui21], table 1 and figures 1 to 4",
      .conditions =
          "100 steps, variances 1, known initial state 0. On average no filter has a smaller mean squared "
          "error than the exact one, so that published values below it (BA, FA, IFA for most N) cannot be "
          "reached. They would be reached with the true state as \"the newest state value\" of eq. 2, which is "
          "not available to a filter. IFA as published, with stepwise resampling (eqs. 7, 8), and with unbiased "
          "resampling instead. Published times for N = 100, 30 runs: 0.31 s (PF), 0.70 s (BA), 0.75 s (FA), "
          "0.64 s (IFA). NEES: 1 is consistent, more is overconfident.",
      .default_seeds = 500,
      .compared_with = "the bound"};
  study.metrics = {{.name = "RMSE", .unit = "", .is_compared = true},
                   {.name = "NEES", .unit = ""},
                   {.name = "N_eff", .unit = ""},
                   {.name = "time", .unit = "ms", .is_processor_time = true}};
  study.variants = growth_variants(trials);
  study.illustrate = [trial = trials.front()](std::uint64_t seed) { return illustrate_growth(trial, seed); };
  study.run = [trials = std::move(trials)](std::uint64_t seed) { return run_growth_trials(trials, seed); };
  return study;
}

}  // namespace patrol::studies
