#include "app/study/street_study.h"

#include <limits>

#include <fmt/format.h>

#include "app/common/process_cost.h"
#include "app/common/temporary_folder.h"
#include "app/study/pipeline_mapper.h"
#include "app/study/study_run.h"
#include "score/map_error.h"
#include "score/pose/trajectory_error.h"
#include "score/station_error.h"

namespace patrol::app {
namespace {

constexpr double kNoStreetMetric = std::numeric_limits<double>::quiet_NaN();
constexpr int kSwarmParticles = 30;
constexpr const char* kScenario = "worlds/street/scenarios/patrol.yaml";

/// Method with its proposal for the particles at a keyframe.
struct GridMethod {
  std::string name;
  int particles = 0;
  std::string proposal, optimizer;
  std::string mapping = "rbpf";
  std::vector<std::optional<double>> published{};  ///< published errors of box 1, box 2 and well 3; m
};

const std::vector<GridMethod> kStreetMethods = {
    {.name = "FastSLAM",
     .particles = kSwarmParticles,
     .proposal = "motion",
     .optimizer = "none",
     .published = {1.05, 1.31, 1.58}},
    {.name = "WOA",
     .particles = kSwarmParticles,
     .proposal = "motion",
     .optimizer = "woa",
     .published = {1.01, 1.23, 1.24}},
    {.name = "SCSO", .particles = kSwarmParticles, .proposal = "motion", .optimizer = "scso"},
    {.name = "ISCSO",
     .particles = kSwarmParticles,
     .proposal = "motion",
     .optimizer = "iscso",
     .published = {0.92, 1.17, 1.18}},
    {.name = "IFA", .particles = kSwarmParticles, .proposal = "motion", .optimizer = "ifa"},
    {.name = "scan matching (this work)", .particles = 8, .proposal = "scan_match", .optimizer = "none"},
    {.name = "pose graph (this work, default)",
     .particles = 1,
     .proposal = "scan_match",
     .optimizer = "none",
     .mapping = "graph"}};

const std::vector<studies::StudyMetric> kStreetMetrics = {{.name = "box 1", .unit = "m", .is_compared = true},
                                                          {.name = "box 2", .unit = "m", .is_compared = true},
                                                          {.name = "well 3", .unit = "m", .is_compared = true},
                                                          {.name = "map to nearest surface", .unit = "m"},
                                                          {.name = "pose RMSE", .unit = "m"},
                                                          {.name = "time", .unit = "s", .is_processor_time = true},
                                                          {.name = "memory", .unit = "MB", .is_processor_time = true}};

struct Mapped {
  Trajectory T_map_body;
  OccupancyGrid map;
  double seconds = 0.0, memory_mb = 0.0;
};

Mapped map_by(const GridMethod& method, const StudyRun& patrol) {
  stack::StackSettings settings = patrol.scenario.stack;
  settings.slam.method = method.mapping;
  settings.slam.rbpf.filter.proposal = method.proposal;
  settings.slam.rbpf.filter.optimizer = method.optimizer;
  settings.slam.rbpf.filter.particles = method.particles;
  const double before_mb = heap_mb();
  PipelineMapper mapper(settings, patrol.files.robot, patrol.scenario.seed);
  mapper.map(patrol.log);
  return {.T_map_body = mapper.T_map_body(),
          .map = mapper.map(),
          .seconds = mapper.seconds(),
          .memory_mb = heap_mb() - before_mb};
}

std::vector<double> flatten_metrics(const Mapped& mapped, const StudyRun& patrol) {
  const Pose2 T_world_map = score::align_at_start(mapped.T_map_body, patrol.record.T_world_body);
  const score::ReferenceMap& reference = patrol.truth.reference;
  const score::DistanceField reference_field(score::occupied_cells(reference.cells));
  std::vector<double> metrics;
  for (const score::StationError& station :
       score::station_errors(patrol.files.route, patrol.record.events, T_world_map, T_world_map,
                             patrol.record.T_world_body, mapped.map, reference_field)) {
    metrics.push_back(station.map_error_m.value_or(kNoStreetMetric));
  }
  metrics.resize(3, kNoStreetMetric);
  metrics.push_back(score::map_error(mapped.map, T_world_map, reference, reference_field).nearest_mean_m);
  metrics.push_back(score::trajectory_error(mapped.T_map_body, T_world_map, patrol.record.T_world_body).ate_rmse_m);
  metrics.push_back(mapped.seconds);
  metrics.push_back(mapped.memory_mb);
  return metrics;
}

studies::StudySample run_street(std::uint64_t seed) {
  const TemporaryFolder folder(fmt::format("study-{}", seed));
  const StudyRun patrol = run_for_study(kScenario, {}, seed, folder.path());
  studies::StudySample sample;
  for (const GridMethod& method : kStreetMethods) sample.push_back(flatten_metrics(map_by(method, patrol), patrol));
  return sample;
}

/// Maps of all methods, colored by their errors.
std::vector<report::Section> illustrate_street(std::uint64_t seed) {
  const TemporaryFolder folder(fmt::format("study-{}", seed));
  const StudyRun patrol = run_for_study(kScenario, {}, seed, folder.path());
  std::vector<report::Section> sections;
  for (const GridMethod& method : kStreetMethods) {
    const Mapped mapped = map_by(method, patrol);
    sections.push_back({method.name, {map_error_block(mapped.map, mapped.T_map_body, patrol)}});
  }
  return sections;
}

}  // namespace

studies::Study street_study() {
  studies::Study study{
      .name = "street-map",
      .title = "Mapping of the street with different proposals",
      .source = "[Wu25], table 2",
      .conditions =
          "Each seed is one simulated patrol (worlds/street/scenarios/patrol.yaml), whose log is mapped by all "
          "methods. The published values are of another street, quadruped and lidar, and of one run. box 1, "
          "box 2, well 3: position error of the object in the built map.",
      .default_seeds = 5,
      .compared_with = "FastSLAM"};
  study.metrics = kStreetMetrics;
  for (const GridMethod& method : kStreetMethods) {
    study.variants.push_back({.world = "street",
                              .method = method.name,
                              .particles = method.particles,
                              .reference = 0,
                              .published = method.published});
  }
  study.run = run_street;
  study.illustrate = illustrate_street;
  return study;
}

}  // namespace patrol::app
