#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/scenario.h"
#include "app/study/scan_world.h"
#include "core/geometry/angles.h"
#include "core/random.h"
#include "sim/sensors/panoramic_scanner.h"

namespace patrol::app::scanner_choice_test {
namespace {

/// Settings of the rule that chooses the positions of the scanner.
struct ScannerChoiceSettings {
  double pose_spacing_m = 2.5;    ///< distance between the lidars on the roads
  double grid_m = 1.5;            ///< distance between the candidates
  double max_from_road_m = 1.5;   ///< largest distance of a candidate from a center line
  double free_m = 0.7;            ///< free distance around a candidate
  double edge_weight = 0.5;       ///< weight that a beam at an edge loses if the scanner's beams are kEdge_m apart
  double max_spacing_m = 0.8;     ///< largest distance of the scanner's beams on a surface that counts as seen
  float planar_weight = 0.7f;     ///< weight of the 2D lidar relative to that of the 3D lidar
  std::size_t num_restarts = 40;  ///< number of restarts of the exchange, each without three positions
};

/// Rule of a surveyor with a model of the site: positions on the roads from which the scanner sees what lidars on the
/// roads see. Beams of a 2D and a 3D lidar from regular positions along the roads end on the surfaces of the empty
/// world. The value of a beam is 1 if a scanner sees its surface, less at edges, which distant scanners measure
/// coarsely. Positions are chosen greedily, then exchanged one by one, then chosen again without three of them, as long
/// as the sum of the values grows. Independent of the held-out poses and of the seeds of the study.
class ScannerChoice {
 public:
  ScannerChoice(const ScannedWorld& world, const ScannerChoiceSettings& settings);

  /// Returns `count` positions of the largest value that the search finds.
  std::vector<Eigen::Vector2d> choose(std::size_t count) const;
  /// Returns the mean value of the beams for scanners at positions, 0 ... 1.
  double value_of(const std::vector<Eigen::Vector2d>& scanners_m) const;

 private:
  using Values = std::vector<std::uint8_t>;  ///< [beam], up to kFullValue
  /// End of a beam.
  struct Target {
    Eigen::Vector3d p_m;
    float weight;
    bool is_edge;  ///< whether a beam 3 cm beside it ends elsewhere
  };

  void add_targets(const Eigen::Vector2d& p_m, double phase);
  void add_target(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_range_m, float weight);
  void add_candidates();
  Values values_at(const Eigen::Vector2d& p_m) const;
  Values best_of(const std::vector<std::size_t>& chosen, std::size_t without) const;
  double mean(const Values& values) const;
  std::size_t best_addition(const Values& values) const;
  bool exchange(std::vector<std::size_t>& chosen, int max_rounds) const;

  const ScannedWorld& world_;
  ScannerChoiceSettings settings_;
  RayWorld rays_;
  std::vector<Target> targets_;
  std::vector<Eigen::Vector2d> candidates_m_;
  std::vector<Values> values_;  ///< [candidate]
};

constexpr double kHead_m = 1.7, kPlanar_m = 0.55, kSpatial_m = 0.8;  // heights of the scanner and of the lidars
constexpr double kPlanarRange_m = 30.0, kSpatialRange_m = 100.0;
constexpr double kGrazing = 0.0872;  // cosine of 85 degrees
constexpr double kEdge_m = 0.08;
constexpr double kFullValue = 250.0;
constexpr double kTurn_rad = 2.0 * std::numbers::pi;

Eigen::Vector3d level_direction(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}

double distance_from_roads_m(const ScannedWorld& world, const Eigen::Vector2d& p_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const auto& road : world.roads_m) {
    for (std::size_t i = 1; i < road.size(); ++i) {
      const Eigen::Vector2d along = road[i] - road[i - 1];
      const double t = std::clamp(along.dot(p_m - road[i - 1]) / along.squaredNorm(), 0.0, 1.0);
      nearest_m = std::min(nearest_m, (road[i - 1] + t * along - p_m).norm());
    }
  }
  return nearest_m;
}

/// Returns whether nothing is within a distance of an upright scanner, as far as level beams see.
bool is_free(const RayWorld& rays, const Eigen::Vector2d& p_m, double free_m) {
  constexpr double kMaxGround_m = 0.3;
  const double ground_m = rays.ground_m(p_m);
  if (!(std::abs(ground_m) < kMaxGround_m)) return false;
  for (int beam = 0; beam < 72; ++beam) {
    for (const double height_m : {0.4, 1.0, kHead_m}) {
      if (rays.scene().cast({p_m.x(), p_m.y(), ground_m + height_m}, level_direction(kTurn_rad * beam / 72, 0.0),
                            free_m, sim::kRayScenery))
        return false;
    }
  }
  return true;
}

ScannerChoice::ScannerChoice(const ScannedWorld& world, const ScannerChoiceSettings& settings)
    : world_(world), settings_(settings), rays_(load_site(world.name, find_data_root("")).world_xml.string()) {
  constexpr double kGolden = 0.618, kAside_m = 0.8;
  double phase = 0.0;
  int count = 0;
  for (const auto& road : world.roads_m) {
    for (std::size_t i = 1; i < road.size(); ++i) {
      const Eigen::Vector2d along = (road[i] - road[i - 1]).normalized(), left(-along.y(), along.x());
      const double length_m = (road[i] - road[i - 1]).norm();
      for (double s = 0.5 * settings.pose_spacing_m; s < length_m; s += settings.pose_spacing_m) {
        ++count;
        phase = std::fmod(phase + kGolden, 1.0);
        add_targets(road[i - 1] + s * along + kAside_m * (count % 3 - 1) * left, phase);
      }
    }
  }
  add_candidates();
  for (const Eigen::Vector2d& p : candidates_m_) values_.push_back(values_at(p));
}

void ScannerChoice::add_targets(const Eigen::Vector2d& p_m, double phase) {
  constexpr int kPlanarBeams = 36, kRings = 16, kRingBeams = 12;
  const double ground_m = rays_.ground_m(p_m);
  const float planar_weight = settings_.planar_weight * kRings * kRingBeams / kPlanarBeams;
  for (int k = 0; k < kPlanarBeams; ++k) {
    add_target({p_m.x(), p_m.y(), ground_m + kPlanar_m}, level_direction(kTurn_rad * (k + phase) / kPlanarBeams, 0.0),
               kPlanarRange_m, planar_weight);
  }
  for (int ring = 0; ring < kRings; ++ring) {
    for (int k = 0; k < kRingBeams; ++k) {
      add_target({p_m.x(), p_m.y(), ground_m + kSpatial_m},
                 level_direction(kTurn_rad * (k + phase + 0.37 * ring) / kRingBeams, to_rad(-15.0 + 2.0 * ring)),
                 kSpatialRange_m, 1.0f);
    }
  }
}

void ScannerChoice::add_target(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_range_m,
                               float weight) {
  constexpr double kBeside_m = 0.03, kFar_m = 1e9;
  const auto hit = rays_.scene().cast(origin, direction, max_range_m, sim::kRayScenery);
  if (hit && std::abs(hit->normal.dot(direction)) < kGrazing) return;
  const double range_m = hit ? hit->distance_m : kFar_m;
  // A surface at the largest incidence is no edge.
  const double same_m = 0.1 + (hit ? kBeside_m / kGrazing : 0.0);
  Target target{.p_m = origin + range_m * direction, .weight = weight, .is_edge = false};
  bool is_target = hit.has_value();
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(direction).normalized(), up = direction.cross(left);
  for (const Eigen::Vector3d& aside : {Eigen::Vector3d(-left), left, Eigen::Vector3d(-up), up}) {
    const Eigen::Vector3d from = origin + kBeside_m * aside;
    const auto beside = rays_.scene().cast(from, direction, max_range_m, sim::kRayScenery);
    const double beside_m = beside ? beside->distance_m : kFar_m;
    if (std::abs(beside_m - range_m) <= same_m) continue;
    target.is_edge = true;
    if (beside_m > range_m) continue;
    target.p_m = from + beside_m * direction;
    is_target = true;
  }
  if (is_target) targets_.push_back(target);
}

void ScannerChoice::add_candidates() {
  constexpr double kTruckLength_m = 5.0, kTruckWidth_m = 2.5, kPerson_m = 2.0;  // distances kept from the guests
  Eigen::AlignedBox2d box;
  for (const auto& road : world_.roads_m) {
    for (const Eigen::Vector2d& p : road) box.extend(p);
  }
  const Eigen::Vector2d first = box.min() - Eigen::Vector2d::Ones(), last = box.max() + Eigen::Vector2d::Ones();
  for (double x = first.x(); x <= last.x(); x += settings_.grid_m) {
    for (double y = first.y(); y <= last.y(); y += settings_.grid_m) {
      const Eigen::Vector2d p(x, y);
      const Eigen::Vector2d from_truck = (p - world_.truck_m).cwiseAbs();
      if (from_truck.x() < kTruckLength_m && from_truck.y() < kTruckWidth_m) continue;
      if ((p - world_.person_m).norm() < kPerson_m || distance_from_roads_m(world_, p) > settings_.max_from_road_m)
        continue;
      if (is_free(rays_, p, settings_.free_m)) candidates_m_.push_back(p);
    }
  }
}

ScannerChoice::Values ScannerChoice::values_at(const Eigen::Vector2d& p_m) const {
  constexpr double kSame_m = 0.02;
  const Eigen::Vector3d origin(p_m.x(), p_m.y(), rays_.ground_m(p_m) + kHead_m);
  const double step_rad = to_rad(world_.step_deg);
  const PanoramicScannerSettings scanner;
  Values values(targets_.size(), 0);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const double distance_m = (targets_[i].p_m - origin).norm();
    if (distance_m < scanner.range_min_m || distance_m > scanner.range_max_m) continue;
    const Eigen::Vector3d direction = (targets_[i].p_m - origin) / distance_m;
    const auto hit = rays_.scene().cast(origin, direction, distance_m + kSame_m, sim::kRayScenery);
    if (!hit || hit->distance_m < distance_m - kSame_m) continue;
    const double cosine = std::abs(hit->normal.dot(direction)), beams_m = distance_m * step_rad;
    if (!targets_[i].is_edge && (cosine < kGrazing || beams_m > settings_.max_spacing_m * cosine)) continue;
    const double value = targets_[i].is_edge ? 1.0 - settings_.edge_weight * std::min(1.0, beams_m / kEdge_m) : 1.0;
    values[i] = static_cast<std::uint8_t>(std::lround(kFullValue * value));
  }
  return values;
}

ScannerChoice::Values ScannerChoice::best_of(const std::vector<std::size_t>& chosen, std::size_t without) const {
  Values best(targets_.size(), 0);
  for (const std::size_t at : chosen) {
    if (at == without) continue;
    for (std::size_t i = 0; i < best.size(); ++i) best[i] = std::max(best[i], values_[at][i]);
  }
  return best;
}

double ScannerChoice::mean(const Values& values) const {
  double sum = 0.0, full = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += double{targets_[i].weight} * values[i];
    full += double{targets_[i].weight} * kFullValue;
  }
  return full > 0.0 ? sum / full : 0.0;
}

std::size_t ScannerChoice::best_addition(const Values& values) const {
  std::size_t best = 0;
  double best_gain = -1.0;
  for (std::size_t at = 0; at < values_.size(); ++at) {
    double gain = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values_[at][i] > values[i]) gain += double{targets_[i].weight} * (values_[at][i] - values[i]);
    }
    if (gain <= best_gain) continue;
    best_gain = gain;
    best = at;
  }
  return best;
}

bool ScannerChoice::exchange(std::vector<std::size_t>& chosen, int max_rounds) const {
  bool is_changed = false;
  for (int round = 0; round < max_rounds; ++round) {
    const double before = mean(best_of(chosen, values_.size()));
    std::vector<std::size_t> exchanged = chosen;
    for (std::size_t& at : exchanged) at = best_addition(best_of(exchanged, at));
    if (mean(best_of(exchanged, values_.size())) <= before) break;
    chosen = std::move(exchanged);
    is_changed = true;
  }
  return is_changed;
}

std::vector<Eigen::Vector2d> ScannerChoice::choose(std::size_t count) const {
  constexpr int kRounds = 6, kRestartRounds = 3;
  constexpr std::size_t kReplaced = 3;
  const std::size_t none = values_.size();
  const auto complete = [&](std::vector<std::size_t>& chosen) {
    while (chosen.size() < count) chosen.push_back(best_addition(best_of(chosen, none)));
  };
  std::vector<std::size_t> best;
  complete(best);
  exchange(best, kRounds);
  const RandomStream draw(1, "scanner_choice");
  for (std::size_t restart = 0; restart < settings_.num_restarts && count > kReplaced; ++restart) {
    const auto random = draw.uniforms(restart), candidate = draw.uniforms(restart, 1);
    std::vector<std::size_t> trial = best;
    for (std::size_t k = 0; k < kReplaced; ++k) {
      trial.erase(trial.begin() + static_cast<std::ptrdiff_t>(random[k] * static_cast<double>(trial.size())));
    }
    trial.push_back(static_cast<std::size_t>(candidate[0] * static_cast<double>(none)));
    complete(trial);
    exchange(trial, kRestartRounds);
    if (mean(best_of(trial, none)) > mean(best_of(best, none))) best = trial;
  }
  std::vector<Eigen::Vector2d> scanners_m;
  for (const std::size_t at : best) scanners_m.push_back(candidates_m_[at]);
  return scanners_m;
}

double ScannerChoice::value_of(const std::vector<Eigen::Vector2d>& scanners_m) const {
  Values best(targets_.size(), 0);
  for (const Eigen::Vector2d& p : scanners_m) {
    const Values values = values_at(p);
    for (std::size_t i = 0; i < best.size(); ++i) best[i] = std::max(best[i], values[i]);
  }
  return mean(best);
}

const ScannedWorld& substation() { return scanned_worlds().at(1); }

/// Settings for a fraction of the time: 2 s instead of 1 min.
constexpr ScannerChoiceSettings kCoarse = {.pose_spacing_m = 12.0, .grid_m = 6.0, .num_restarts = 2};

TEST(ScannerChoice, PositionsOfTheSubstationSeeMoreThanThoseChosenByHand) {
  const std::vector<Eigen::Vector2d> by_hand = {{8.0, 8.0},    {40.0, 8.0},  {75.0, 8.0},  {111.0, 9.0},
                                                {112.0, 45.0}, {86.0, 34.0}, {59.0, 40.0}, {32.0, 55.5},
                                                {85.0, 56.0},  {8.0, 60.0},  {35.0, 82.0}, {90.0, 82.0}};
  const ScannerChoice choice(substation(), kCoarse);
  EXPECT_GT(choice.value_of(substation().scanners_m), choice.value_of(by_hand) + 0.02);
}

TEST(ScannerChoice, RestartsAndMorePositionsIncreaseTheValue) {
  ScannerChoiceSettings settings = kCoarse;
  const ScannerChoice choice(substation(), settings);
  settings.num_restarts = 0;
  const ScannerChoice once(substation(), settings);
  const double value = choice.value_of(choice.choose(12));
  EXPECT_GE(value, choice.value_of(once.choose(12)));
  EXPECT_GT(value, choice.value_of(choice.choose(6)) + 0.05);
}

TEST(ScannerChoice, PositionsAreOnTheRoadsAndAwayFromTheTruck) {
  for (const Eigen::Vector2d& p : ScannerChoice(substation(), kCoarse).choose(12)) {
    const bool is_at_truck = std::abs(p.x() - substation().truck_m.x()) < 5.0 && std::abs(p.y() - 7.0) < 2.5;
    EXPECT_FALSE(is_at_truck) << p.transpose();
    EXPECT_TRUE(p.x() > 5.0 && p.x() < 115.0 && p.y() > 5.0 && p.y() < 85.0) << p.transpose();
  }
}

// The stored positions were found by the search with the default settings, which takes 1 min.
TEST(ScannerChoice, PositionsOfTheSubstationHaveAtLeastTheValueOfACoarseSearch) {
  const ScannerChoice choice(substation(), kCoarse);
  EXPECT_GE(choice.value_of(substation().scanners_m), choice.value_of(choice.choose(12)));
}

}  // namespace
}  // namespace patrol::app::scanner_choice_test
