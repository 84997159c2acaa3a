#include "app/study/site_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/angles.h"
#include "core/random.h"
#include "importer/grid/height_grid.h"
#include "sim/sensors/surface_optics.h"

namespace patrol::app {
namespace {

constexpr double kMaxRange2d_m = 30.0, kMaxRange3d_m = 100.0;
constexpr double kLidarHeight_m = 0.55, kLidar3dHeight_m = 0.8;
constexpr double kMinCosine = 0.0872;  // 85 degrees, the incidence beyond which lidars get no return

/// Pose of a held-out scan: position on the ground.
std::vector<Eigen::Vector3d> held_out_poses(const ScannedWorld& world, const RayWorld& truth, int count,
                                            std::uint64_t seed) {
  constexpr double kPoseClearance_m = 0.6;
  constexpr int kMaxDraws = 100'000;
  std::vector<double> ends_m;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> legs;
  for (const auto& road : world.roads_m) {
    for (std::size_t i = 1; i < road.size(); ++i) {
      legs.emplace_back(road[i - 1], road[i]);
      ends_m.push_back((ends_m.empty() ? 0.0 : ends_m.back()) + (road[i] - road[i - 1]).norm());
    }
  }
  const RandomStream draw(seed, "scan_import/poses");
  std::vector<Eigen::Vector3d> poses;
  for (int i = 0; i < kMaxDraws && static_cast<int>(poses.size()) < count; ++i) {
    const auto random = draw.uniforms(static_cast<std::uint64_t>(i));
    const auto leg = static_cast<std::size_t>(
        std::lower_bound(ends_m.begin(), ends_m.end(), random[0] * ends_m.back()) - ends_m.begin());
    const auto& [a, b] = legs[leg];
    const Eigen::Vector2d along = (b - a).normalized(), left(-along.y(), along.x());
    const Eigen::Vector2d p = a + random[1] * (b - a) + world.half_road_m * (2.0 * random[2] - 1.0) * left;
    constexpr double kSameLevel_m = 0.15;
    const double ground_m = truth.ground_m(p);
    if (!(std::abs(ground_m - truth.ground_m(a + random[1] * (b - a))) < kSameLevel_m)) continue;
    bool is_free = true;
    for (int beam = 0; beam < 48 && is_free; ++beam) {
      const double angle = 2.0 * std::numbers::pi * beam / 48;
      for (const double height_m : {0.25, kLidarHeight_m, kLidar3dHeight_m}) {
        is_free =
            is_free && !truth.scene().cast({p.x(), p.y(), ground_m + height_m}, {std::cos(angle), std::sin(angle), 0.0},
                                           kPoseClearance_m, sim::kRayScenery);
      }
    }
    if (is_free) poses.emplace_back(p.x(), p.y(), ground_m);
  }
  return poses;
}

/// First surface on a beam.
struct FirstSurface {
  double range_m = std::numeric_limits<double>::infinity();
  bool is_returned = false;
};

FirstSurface first_surface(const RayWorld& world, const std::vector<sim::SurfaceOptics>& surfaces,
                           const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_range_m) {
  const auto hit = world.scene().cast(origin, direction, max_range_m, sim::kRayScenery);
  if (!hit) return {};
  const double cosine = std::abs(hit->normal.dot(direction));
  return {.range_m = hit->distance_m,
          .is_returned =
              cosine >= kMinCosine && !surfaces[static_cast<std::size_t>(hit->geom)].is_transparent_at(cosine)};
}

/// Surfaces of a world that its scanners see.
class SeenSurfaces {
 public:
  SeenSurfaces(const ScannedWorld& world, const RayWorld& truth)
      : truth_(truth), lowest_(std::sin(to_rad(world.elevation_min_deg))) {
    for (const Eigen::Vector2d& p : world.scanners_m)
      scanners_m_.emplace_back(p.x(), p.y(), truth.ground_m(p) + kScannerHeight_m);
  }

  /// Returns whether the line from a scanner to a point of a surface is free and within the limits of the scanner.
  bool contain(const Eigen::Vector3d& p_m) const {
    constexpr double kSame_m = 0.02;
    const double max_range_m = PanoramicScannerSettings{}.range_max_m;
    return std::any_of(scanners_m_.begin(), scanners_m_.end(), [&](const Eigen::Vector3d& scanner_m) {
      const double distance_m = (p_m - scanner_m).norm();
      if (distance_m > max_range_m) return false;
      const Eigen::Vector3d direction = (p_m - scanner_m) / distance_m;
      if (direction.z() < lowest_) return false;
      const auto hit = truth_.scene().cast(scanner_m, direction, distance_m + kSame_m, sim::kRayScenery);
      return hit && hit->distance_m > distance_m - kSame_m && std::abs(hit->normal.dot(direction)) >= kMinCosine;
    });
  }

 private:
  const RayWorld& truth_;
  double lowest_;  ///< sine of the lowest elevation of the beams
  std::vector<Eigen::Vector3d> scanners_m_;
};

class DifferenceSampler {
 public:
  DifferenceSampler(const RayWorld& truth, const RayWorld& site, const SeenSurfaces& seen)
      : truth_(truth),
        site_(site),
        seen_(seen),
        truth_optics_(sim::surface_optics(truth.scene().model())),
        site_optics_(sim::surface_optics(site.scene().model())) {}

  void add(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_range_m) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    const FirstSurface a = first_surface(truth_, truth_optics_, origin, direction, max_range_m),
                       b = first_surface(site_, site_optics_, origin, direction, max_range_m);
    double difference_m =
        std::isfinite(a.range_m) && std::isfinite(b.range_m) ? std::abs(a.range_m - b.range_m) : kInfinite;
    if (!a.is_returned) {
      if (!b.is_returned || difference_m <= kSame_m) return;
      difference_m = kInfinite;
    }
    differences_m_.push_back(difference_m);
    if (std::isfinite(a.range_m) && !seen_.contain(origin + a.range_m * direction)) return;
    ++num_seen_;
    num_seen_within_ += difference_m <= kSame_m ? 1 : 0;
  }

  RangeDifferences take() {
    std::sort(differences_m_.begin(), differences_m_.end());
    const std::size_t n = differences_m_.size();
    if (n == 0) return {};
    const auto fraction = [](std::size_t part, std::size_t whole) {
      return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(1, whole));
    };
    const auto within = std::upper_bound(differences_m_.begin(), differences_m_.end(), kSame_m);
    return {.median_m = differences_m_[n / 2],
            .p95_m = differences_m_[n * 95 / 100],
            .within_10cm = fraction(static_cast<std::size_t>(within - differences_m_.begin()), n),
            .seen = fraction(num_seen_, n),
            .seen_within_10cm = fraction(num_seen_within_, num_seen_),
            .num_beams = n};
  }

 private:
  static constexpr double kSame_m = 0.1;

  const RayWorld &truth_, &site_;
  const SeenSurfaces& seen_;
  std::vector<sim::SurfaceOptics> truth_optics_, site_optics_;
  std::vector<double> differences_m_;
  std::size_t num_seen_ = 0, num_seen_within_ = 0;
};

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(fraction * static_cast<double>(values.size())))];
}

/// Returns the fraction of beams from the poses to a box that hit something in it in the site and not in the world.
double hits_in(const Eigen::AlignedBox3d& box, const std::vector<Eigen::Vector3d>& poses, const RayWorld& truth,
               const RayWorld& site, std::uint64_t seed) {
  constexpr double kNear_m = 30.0;
  const RandomStream draw(seed, "scan_import/guests");
  std::size_t num_beams = 0, num_hits = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d origin = poses[i] + Eigen::Vector3d(0.0, 0.0, kLidar3dHeight_m);
    if (box.exteriorDistance(origin) > kNear_m || box.contains(origin)) continue;
    for (std::uint64_t k = 0; k < 50; ++k) {
      const auto random = draw.uniforms(i, k);
      const Eigen::Vector3d target =
          box.min() + Eigen::Vector3d(random[0], random[1], random[2]).cwiseProduct(box.sizes());
      const Eigen::Vector3d direction = (target - origin).normalized();
      const auto in_box = [&](const RayWorld& world) {
        const auto hit = world.scene().cast(origin, direction, 100.0, sim::kRayScenery);
        return hit && box.contains(origin + hit->distance_m * direction);
      };
      ++num_beams;
      if (in_box(site) && !in_box(truth)) ++num_hits;
    }
  }
  return num_beams == 0 ? std::numeric_limits<double>::quiet_NaN()
                        : static_cast<double>(num_hits) / static_cast<double>(num_beams);
}

}  // namespace

SiteComparison compare_site(const ScannedWorld& world, const importer::ImportedSite& site, const std::string& site_xml,
                            int num_poses, std::uint64_t seed) {
  constexpr int kBeams2d = 720, kRings = 16, kBeams3d = 360;
  const RayWorld truth(world_xml(world)), imported(site_xml);
  const std::vector<Eigen::Vector3d> poses = held_out_poses(world, truth, num_poses, seed);
  const SeenSurfaces seen(world, truth);
  DifferenceSampler planar(truth, imported, seen), spatial(truth, imported, seen);
  const Grid<float>* ground = nullptr;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const importer::SiteShape& shape : site.shapes) {
    if (shape.type == importer::SiteShapeType::kHeightField) ground = &shape.height_field.height_m;
    if (shape.type == importer::SiteShapeType::kBox) {
      boxes.emplace_back(shape.T_site_shape.position - shape.size_m, shape.T_site_shape.position + shape.size_m);
    }
  }
  std::vector<double> ground_errors_m;
  SiteComparison comparison;
  for (const Eigen::Vector3d& pose : poses) {
    const Eigen::Vector3d at_2d = pose + Eigen::Vector3d(0, 0, kLidarHeight_m),
                          at_3d = pose + Eigen::Vector3d(0, 0, kLidar3dHeight_m);
    for (int beam = 0; beam < kBeams2d; ++beam) {
      const double angle = 2.0 * std::numbers::pi * beam / kBeams2d;
      planar.add(at_2d, {std::cos(angle), std::sin(angle), 0.0}, kMaxRange2d_m);
    }
    for (int ring = 0; ring < kRings; ++ring) {
      const double elevation = to_rad(-15.0 + 2.0 * ring);
      for (int beam = 0; beam < kBeams3d; ++beam) {
        const double angle = 2.0 * std::numbers::pi * beam / kBeams3d;
        spatial.add(at_3d,
                    {std::cos(elevation) * std::cos(angle), std::cos(elevation) * std::sin(angle), std::sin(elevation)},
                    kMaxRange3d_m);
      }
    }
    if (ground != nullptr)
      ground_errors_m.push_back(std::abs(importer::interpolated(*ground, pose.head<2>()) - pose.z()));
    constexpr double kRobot_m = 0.4;
    const Eigen::Vector3d middle = pose + Eigen::Vector3d(0, 0, 0.5);
    if (std::any_of(boxes.begin(), boxes.end(), [&](const Eigen::AlignedBox3d& box) {
          if (box.min().z() > pose.z() + 0.8 || box.max().z() < pose.z() + 0.1) return false;
          const Eigen::Vector2d nearest = middle.head<2>().cwiseMax(box.min().head<2>()).cwiseMin(box.max().head<2>());
          return (nearest - middle.head<2>()).norm() < kRobot_m;
        }))
      ++comparison.num_phantoms;
  }
  comparison.planar = planar.take();
  comparison.spatial = spatial.take();
  comparison.ground_median_m = quantile(ground_errors_m, 0.5);
  comparison.ground_p95_m = quantile(ground_errors_m, 0.95);
  Eigen::AlignedBox3d truck(Eigen::Vector3d(world.truck_m.x() - 3.5, world.truck_m.y() - 1.2, 0.3),
                            Eigen::Vector3d(world.truck_m.x() + 3.5, world.truck_m.y() + 1.2, 2.9));
  Eigen::AlignedBox3d person(Eigen::Vector3d(world.person_m.x() - 0.3, world.person_m.y() - 0.3, 0.2),
                             Eigen::Vector3d(world.person_m.x() + 0.3, world.person_m.y() + 0.3, 1.8));
  comparison.person_hits = hits_in(person, poses, truth, imported, seed);
  comparison.truck_hits = hits_in(truck, poses, truth, imported, seed);
  return comparison;
}

}  // namespace patrol::app
