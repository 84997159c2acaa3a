#include "studies/landmark_study.h"

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "core/thread_cpu_time.h"
#include "studies/landmark_methods.h"
#include "studies/landmark_pictures.h"
#include "studies/landmark_track.h"
#include "studies/landmark_world.h"
#include "studies/landmarks/batch_least_squares.h"

namespace patrol::studies {
namespace {

constexpr double kNoLandmarkMetric = std::numeric_limits<double>::quiet_NaN();

const std::vector<StudyMetric> kLandmarkMetrics = {{.name = "position RMSE", .unit = "m", .is_compared = true},
                                                   {.name = "landmark RMSE", .unit = "m", .is_compared = true},
                                                   {.name = "NEES", .unit = ""},
                                                   {.name = "N_eff", .unit = ""},
                                                   {.name = "time", .unit = "s", .is_processor_time = true}};

double root_mean_square(double sum, std::size_t count) {
  return count == 0 ? kNoLandmarkMetric : std::sqrt(sum / static_cast<double>(count));
}

double landmark_rmse_m(const std::vector<std::optional<Eigen::Vector2d>>& found, const LandmarkWorld& world) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i]) continue;
    sum += (*found[i] - world.landmarks_m[i]).squaredNorm();
    ++count;
  }
  return root_mean_square(sum, count);
}

double position_rmse_m(const std::vector<Pose2>& poses, const std::vector<Pose2>& truth) {
  double sum = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) sum += (poses[k].position() - truth[k].position()).squaredNorm();
  return root_mean_square(sum, truth.size());
}

/// Metrics of a method on a run.
std::vector<double> flatten_metrics(const LandmarkTrack& track, bool has_particles, const LandmarkWorld& world,
                                    const LandmarkRun& run) {
  double nees = 0.0, num_effective = 0.0;
  for (std::size_t k = 0; k < run.truth.size(); ++k) {
    const Eigen::Vector2d error = track.estimates[k].T_map_body.position() - run.truth[k].position();
    // 1 mm is added to the standard deviation: coinciding particles have a covariance of zero.
    const Eigen::Matrix2d P = track.estimates[k].covariance.topLeftCorner<2, 2>() + 1e-6 * Eigen::Matrix2d::Identity();
    nees += error.dot(P.inverse() * error);
    num_effective += track.estimates[k].effective_sample_size;
  }
  const auto steps = static_cast<double>(run.truth.size());
  return {position_rmse_m(track.poses(), run.truth), landmark_rmse_m(track.landmarks, world), nees / steps,
          has_particles ? num_effective / steps : kNoLandmarkMetric, track.seconds};
}

std::vector<double> batch_metrics(const LandmarkWorld& world, const LandmarkRun& run, const LandmarkTrack& guess) {
  const double start_s = thread_cpu_time_s();
  const BatchSolution batch = solve_batch(world.motion, world.noise, run.odometry, run.observations,
                                          {.T_map_body = guess.poses(), .landmarks = guess.landmarks});
  return {position_rmse_m(batch.T_map_body, run.truth), landmark_rmse_m(batch.landmarks, world), kNoLandmarkMetric,
          kNoLandmarkMetric, thread_cpu_time_s() - start_s};
}

/// [method's name, particles], published position and landmark errors.
using PublishedLandmarks = std::map<std::pair<std::string, int>, std::vector<std::optional<double>>>;

/// World with the methods of its trial. Batch least squares comes last, based on the last method's result.
struct LandmarkTrial {
  LandmarkWorld world;
  std::vector<LandmarkMethod> methods;
  PublishedLandmarks published{};
};

/// Variants; each method is compared with the first one of equal particle number, or else with the first of all.
std::vector<StudyVariant> variants_of(const std::vector<LandmarkTrial>& trials) {
  std::vector<StudyVariant> variants;
  for (const LandmarkTrial& trial : trials) {
    const std::size_t first = variants.size();
    std::map<int, std::size_t> first_of_particles;
    for (const LandmarkMethod& method : trial.methods) {
      const std::size_t reference =
          method.particles > 0 ? first_of_particles.emplace(method.particles, variants.size()).first->second : first;
      const auto paper = trial.published.find({method.name, method.particles});
      variants.push_back(
          {.world = trial.world.name,
           .method = method.name,
           .particles = method.particles,
           .reference = reference,
           .published = paper == trial.published.end() ? std::vector<std::optional<double>>{} : paper->second});
    }
    variants.push_back(
        {.world = trial.world.name, .method = "batch least squares", .particles = 0, .reference = first});
  }
  return variants;
}

StudySample run_trials(const std::vector<LandmarkTrial>& trials, std::uint64_t seed) {
  StudySample sample;
  for (const LandmarkTrial& trial : trials) {
    const LandmarkRun run = simulate(trial.world, seed);
    LandmarkTrack track;
    for (const LandmarkMethod& method : trial.methods) {
      track = follow(method, trial.world, run, seed);
      sample.push_back(flatten_metrics(track, method.particles > 0, trial.world, run));
    }
    sample.push_back(batch_metrics(trial.world, run, track));
  }
  return sample;
}

/// Completes a study; the figures show the first trial.
Study landmark_study(Study study, std::vector<LandmarkTrial> trials) {
  study.metrics = kLandmarkMetrics;
  study.variants = variants_of(trials);
  study.illustrate = [trial = trials.front()](std::uint64_t seed) {
    return landmark_sections(trial.world, trial.methods, seed);
  };
  study.run = [trials = std::move(trials)](std::uint64_t seed) { return run_trials(trials, seed); };
  return study;
}

/// Methods of [Wu25], FastSLAM first.
std::vector<LandmarkMethod> garden_methods(int particles) {
  return {fast_slam_1(particles), swarm_slam("woa", particles), swarm_slam("scso", particles),
          swarm_slam("iscso", particles)};
}

/// Adds methods that [Wu25] does not contain.
void add_references(int particles, std::vector<LandmarkMethod>& methods) {
  for (const LandmarkMethod& method : {fast_slam_1(particles, 2.0), fast_slam_1(particles, 4.0), fast_slam_2(particles),
                                       iscso_plus(particles), ekf_slam(), invariant_slam()}) {
    methods.push_back(method);
  }
}

const char* const kGardenConditions =
    "[Wu25] states speed (0.5 m/s), time step (0.1 s), range (10 m) and sensor noise (0.5 m; \"5 rad\" is taken as "
    "5 degrees), but neither the layout nor the odometry errors. Here: one lap of about 7 m radius with 24 landmarks, "
    "alternately 2 m inside and outside of the path, observed in all directions. All methods are given the initial "
    "pose "
    "and the stated noise. M: odometry noise of 0.2 m/s and 10 deg/s. S5: 0.1 m/s and 5 deg/s, plus a constant yaw "
    "rate "
    "bias of 2 deg/s unknown to the methods. S3: the same with 3 deg/s. NEES: squared position error normalized by the "
    "estimated covariance; 2 is consistent, more is overconfident. Batch least squares uses all data of the run.";

}  // namespace

Study circle_study() {
  std::vector<LandmarkTrial> trials;
  for (const char* odometry : {"S5", "M", "S3"}) {
    LandmarkTrial& trial =
        trials.emplace_back(LandmarkTrial{.world = garden_world(odometry, true), .methods = garden_methods(10)});
    if (trials.size() == 1) {
      for (const int particles : {50, 100}) {
        for (const LandmarkMethod& method : garden_methods(particles)) trial.methods.push_back(method);
      }
    }
    add_references(10, trial.methods);
  }
  trials.front().published = {
      {{"FastSLAM", 10}, {0.6406, 0.6771}}, {{"WOA", 10}, {0.3491, 0.3411}},      {{"SCSO", 10}, {0.3142, 0.2987}},
      {{"ISCSO", 10}, {0.2088, 0.1921}},    {{"FastSLAM", 50}, {0.4791, 0.5387}}, {{"WOA", 50}, {0.2319, 0.2429}},
      {{"SCSO", 50}, {0.2122, 0.2369}},     {{"ISCSO", 50}, {0.1917, 0.1731}},    {{"FastSLAM", 100}, {0.3773, 0.4276}},
      {{"WOA", 100}, {0.2127, 0.2205}},     {{"SCSO", 100}, {0.1916, 0.2103}},    {{"ISCSO", 100}, {0.1764, 0.1691}}};
  return landmark_study({.name = "landmarks-circle",
                         .title = "FastSLAM with swarm optimizers on a circular course",
                         .source = "[Wu25], table 1 and figures 2 to 4 (20 runs)",
                         .conditions = kGardenConditions,
                         .default_seeds = 200,
                         .compared_with = "FastSLAM"},
                        std::move(trials));
}

Study noncircular_study() {
  std::vector<LandmarkTrial> trials;
  for (const char* odometry : {"S5", "M", "S3"}) {
    LandmarkTrial& trial =
        trials.emplace_back(LandmarkTrial{.world = garden_world(odometry, false), .methods = garden_methods(20)});
    add_references(20, trial.methods);
  }
  return landmark_study({.name = "landmarks-noncircular",
                         .title = "FastSLAM with swarm optimizers on a noncircular course",
                         .source = "[Wu25], figures 5 to 7 (20 particles; no table)",
                         .conditions = kGardenConditions,
                         .default_seeds = 50,
                         .compared_with = "FastSLAM"},
                        std::move(trials));
}

Study campus_study() {
  constexpr int kParticles = 20;
  constexpr double kPathLength_m = 600.0, kStep_s = 0.025;
  const std::vector<LandmarkMethod> published_methods = {fast_slam_1(kParticles), swarm_slam("ba", kParticles),
                                                         swarm_slam("fa", kParticles), swarm_slam("ifa", kParticles)};
  const PublishedLandmarks published = {{{"FastSLAM", kParticles}, {2.2418}},
                                        {{"BA", kParticles}, {1.2234}},
                                        {{"FA", kParticles}, {1.1313}},
                                        {{"IFA", kParticles}, {0.4160}}};
  std::vector<LandmarkTrial> trials;
  for (const bool is_biased : {true, false}) {
    trials.push_back(
        {.world = campus_world(is_biased, 3.0, 8000), .methods = published_methods, .published = published});
    trials.back().methods.push_back(swarm_slam("iscso", kParticles));
    add_references(kParticles, trials.back().methods);
  }
  for (const double speed_mps : {2.0, 5.0}) {
    LandmarkTrial& trial = trials.emplace_back(
        LandmarkTrial{.world = campus_world(true, speed_mps, static_cast<int>(kPathLength_m / speed_mps / kStep_s)),
                      .methods = published_methods});
    trial.world.name += fmt::format(", {:g} m/s", speed_mps);
    trial.methods.push_back(invariant_slam());
  }
  return landmark_study(
      {.name = "landmarks-100x80",
       .title = "FastSLAM with swarm optimizers on a campus",
       .source = "[Cui21], table 3 and figures 5 to 7 (20 runs)",
       .conditions = "[Cui21] states 100 m x 80 m, 15 waypoints, 31 landmarks, 3 m/s, 8000 steps of 0.025 s and the "
                     "errors of range (0.3 m), speed (0.5 m/s) and steering (5 degrees), but neither the layout, the "
                     "particles, the bearing error nor the range of the sensor. Here: 20 particles; bearing error "
                     "1 degree; landmarks within 30 m in the front half are observed at every eighth step. Matched: "
                     "odometry errors as given to the methods. Biased: in addition 0.3 m/s and 2 degrees too much, "
                     "unknown to the methods. Only then does FastSLAM reach the published 2.24 m, to which the size of "
                     "the course was chosen. Other speeds: 600 m each.",
       .default_seeds = 20,
       .compared_with = "FastSLAM"},
      std::move(trials));
}

}  // namespace patrol::studies
