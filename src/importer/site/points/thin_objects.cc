#include "importer/site/points/thin_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/geometry/convex_polygon.h"
#include "importer/site/points/beam_evidence.h"
#include "importer/site/points/post_fit.h"

namespace patrol::importer {
namespace {

constexpr double kSampleRatio = 0.6;  // of the distance of samples and the size of cells

/// Point of a surface on the outline of an object.
struct OutlinePoint {
  Eigen::Vector3d p_m;
  std::size_t patch = 0;
};

/// Removes corners of the hull that are closer than a centimeter to the line between their neighbors.
std::vector<Eigen::Vector2d> simplified(const std::vector<Eigen::Vector2d>& hull) {
  constexpr double kFlat_m = 0.01;
  std::vector<Eigen::Vector2d> corners;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d& before = corners.empty() ? hull.back() : corners.back();
    const Eigen::Vector2d along = hull[(i + 1) % hull.size()] - before, off = hull[i] - before;
    const double distance =
        along.norm() > 1e-9 ? std::abs(along.x() * off.y() - along.y() * off.x()) / along.norm() : off.norm();
    if (distance > kFlat_m) corners.push_back(hull[i]);
  }
  return corners;
}

/// Returns the index of the side of an outline that is nearest to a point.
std::size_t nearest_side(const ConvexPolygon& outline_m, const Eigen::Vector2d& p_m) {
  std::size_t nearest = 0;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline_m.size(); ++i) {
    const Eigen::Vector2d &a = outline_m[i], along = outline_m[(i + 1) % outline_m.size()] - a;
    const double t = std::clamp(along.dot(p_m - a) / std::max(1e-12, along.squaredNorm()), 0.0, 1.0);
    const double distance_m = (a + t * along - p_m).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    nearest = i;
  }
  return nearest;
}

Eigen::Vector3f site_point(const Eigen::Vector2d& p_m, double height_m) {
  return Eigen::Vector3d(p_m.x(), p_m.y(), height_m).cast<float>();
}

class ThinObjectCloser {
 public:
  ThinObjectCloser(const std::vector<Patch>& patches, std::vector<Panorama>& scans, const ThinObjectSettings& settings)
      : patches_(patches), scans_(scans), settings_(settings) {}

  /// Closes the thin objects of a layer.
  void close_layer(const std::vector<OutlinePoint>& points, double low_m, double height_m, double cell_m) {
    for (const std::vector<OutlinePoint>& object : connected(points, cell_m)) {
      if (extent_m(object) <= settings_.max_extent_m && close_object(object, low_m, height_m)) continue;
      if (cell_m > settings_.fine_cell_m) {
        close_layer(object, low_m, height_m, settings_.fine_cell_m);
        continue;
      }
      if (0.5 * height_m < settings_.min_layer_m - 1e-9 || extent_m(object) > settings_.max_extent_m) continue;
      std::vector<OutlinePoint> lower, upper;
      const double middle_m = low_m + 0.5 * height_m;
      for (const OutlinePoint& point : object) (point.p_m.z() < middle_m ? lower : upper).push_back(point);
      close_layer(lower, low_m, 0.5 * height_m, cell_m);
      close_layer(upper, middle_m, 0.5 * height_m, cell_m);
    }
  }

  std::vector<Patch> take() { return std::move(sides_); }

 private:
  static double extent_m(const std::vector<OutlinePoint>& object) {
    Eigen::AlignedBox2d extent;
    for (const OutlinePoint& point : object) extent.extend(point.p_m.head<2>());
    return extent.sizes().maxCoeff();
  }

  /// Divides points into groups in connected cells.
  static std::vector<std::vector<OutlinePoint>> connected(const std::vector<OutlinePoint>& points, double cell_m) {
    std::map<std::array<int, 2>, std::vector<std::size_t>> cells;
    for (std::size_t i = 0; i < points.size(); ++i)
      cells[{static_cast<int>(std::floor(points[i].p_m.x() / cell_m)),
             static_cast<int>(std::floor(points[i].p_m.y() / cell_m))}]
          .push_back(i);
    std::vector<std::vector<OutlinePoint>> objects;
    std::set<std::array<int, 2>> visited;
    for (const auto& [first, unused] : cells) {
      if (!visited.insert(first).second) continue;
      std::vector<std::array<int, 2>> open = {first};
      std::vector<OutlinePoint>& object = objects.emplace_back();
      for (std::size_t i = 0; i < open.size(); ++i) {
        const std::array<int, 2> at = open[i];
        for (const std::size_t k : cells.at(at)) object.push_back(points[k]);
        for (int k = 0; k < 9; ++k) {
          const std::array<int, 2> next = {at[0] + k % 3 - 1, at[1] + k / 3 - 1};
          if (cells.contains(next) && visited.insert(next).second) open.push_back(next);
        }
      }
    }
    return objects;
  }

  /// Closes an object. Returns false if beams pass through it.
  bool close_object(const std::vector<OutlinePoint>& object, double layer_low_m, double layer_height_m) {
    constexpr double kMinArea_m2 = 4e-4, kStrip_m = 0.01;
    float closest_m = 1e9f;
    for (const OutlinePoint& point : object) closest_m = std::min(closest_m, patches_[point.patch].spacing_m);
    std::vector<Eigen::Vector2d> outline;
    Prism prism{.outline_m = {}, .low_m = 1e9, .high_m = -1e9};
    double light = 0.0;
    for (const OutlinePoint& point : object) {
      const Patch& patch = patches_[point.patch];
      light += double{patch.reflectivity} / static_cast<double>(object.size());
      if (patch.spacing_m > settings_.max_spacing_ratio * closest_m) continue;
      outline.emplace_back(point.p_m.head<2>());
      prism.low_m = std::min(prism.low_m, point.p_m.z());
      prism.high_m = std::max(prism.high_m, point.p_m.z());
    }
    // No gap between an object and its continuation in the next layer.
    const double gap_m = kSampleRatio * settings_.cell_m, layer_high_m = layer_low_m + layer_height_m;
    if (prism.low_m < layer_low_m + gap_m) prism.low_m = layer_low_m;
    if (prism.high_m > layer_high_m - gap_m) prism.high_m = layer_high_m;
    prism.outline_m = simplified(convex_hull(outline));
    if (prism.outline_m.size() < 3) {
      // A post that was seen from one side as a flat strip.
      std::vector<Eigen::Vector2d> wider;
      for (const Eigen::Vector2d& p : outline) {
        for (const double dx : {-kStrip_m, kStrip_m}) {
          for (const double dy : {-kStrip_m, kStrip_m}) wider.push_back(p + Eigen::Vector2d(dx, dy));
        }
      }
      prism.outline_m = convex_hull(wider);
      fit_object(prism, beams_across(prism, scans_, settings_.max_beams), static_cast<float>(light));
      return true;
    }
    const std::vector<PlanBeam> beams = beams_across(prism, scans_, settings_.max_beams);
    if (fit_object(prism, beams, static_cast<float>(light))) return true;
    if (polygon_area(prism.outline_m) < kMinArea_m2) return true;
    if (disagreement(beams, prism.outline_m, Eigen::Vector2d::Zero(), 2.0 * settings_.depth_m) >
        settings_.max_disagreement)
      return false;
    const Eigen::Vector2d center = mean_of(prism.outline_m);
    for (Eigen::Vector2d& corner : prism.outline_m) {
      const Eigen::Vector2d inward = center - corner;
      corner += std::min(1.0, settings_.inset_m / std::max(1e-6, inward.norm())) * inward;
    }
    add_sides(prism, Eigen::Vector2d::Zero(), static_cast<float>(light),
              std::vector<bool>(prism.outline_m.size(), false));
    return true;
  }

  /// Replaces the measured surfaces of a round or rectangular post. Returns false if it is neither.
  bool fit_object(const Prism& hull, const std::vector<PlanBeam>& beams, float reflectivity) {
    std::optional<FittedOutline> best = fit_circle(beams, hull.outline_m);
    const std::optional<FittedOutline> rectangle = fit_rectangle(beams, hull.outline_m);
    if (rectangle && (!best || rectangle->cost < best->cost)) best = rectangle;
    if (!best || best->cost > settings_.max_cost ||
        disagreement(beams, best->outline_m, best->slope, settings_.depth_m) > settings_.max_fit_disagreement)
      return false;
    const Prism prism{.outline_m = best->outline_m, .low_m = hull.low_m, .high_m = hull.high_m};
    std::vector<bool> is_measured(prism.outline_m.size(), false);
    for (const PlanBeam& beam : beams_across(prism, scans_, 1'000'000)) {
      if (!beam.is_hit) continue;
      const PlanCrossing crossing = crossing_of(beam, prism.outline_m, best->slope);
      if (crossing.clearance_m > settings_.edge_m) continue;
      const bool is_on_side = std::abs(beam.range_m - crossing.entry_m) < settings_.depth_m;
      if (crossing.clearance_m > -settings_.edge_m || is_on_side) scans_[beam.scan].state(beam.pixel) |= kPixelCovered;
      if (is_on_side) is_measured[nearest_side(prism.outline_m, beam.origin_m + beam.range_m * beam.direction)] = true;
    }
    add_sides(prism, best->slope, reflectivity, is_measured);
    return true;
  }

  /// Returns the fraction of the beams across an outline, away from its edges, that do not return from its surface.
  double disagreement(const std::vector<PlanBeam>& beams, const ConvexPolygon& outline_m, const Eigen::Vector2d& slope,
                      double depth_m) const {
    std::size_t num_wrong = 0, num_crossing = 0;
    for (const PlanBeam& beam : beams) {
      const PlanCrossing crossing = crossing_of(beam, outline_m, slope);
      if (crossing.clearance_m > -settings_.edge_m) continue;
      ++num_crossing;
      num_wrong += std::abs(beam.range_m - crossing.entry_m) > depth_m ? 1 : 0;
    }
    return num_crossing == 0 ? 0.0 : static_cast<double>(num_wrong) / static_cast<double>(num_crossing);
  }

  static Eigen::Vector2d mean_of(const ConvexPolygon& outline_m) {
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : outline_m) center += corner / static_cast<double>(outline_m.size());
    return center;
  }

  void add_sides(const Prism& prism, const Eigen::Vector2d& slope, float reflectivity,
                 const std::vector<bool>& is_measured) {
    const Eigen::Vector2d up = 0.5 * (prism.high_m - prism.low_m) * slope;
    for (std::size_t i = 0; i < prism.outline_m.size(); ++i) {
      const Eigen::Vector2d &a = prism.outline_m[i], &b = prism.outline_m[(i + 1) % prism.outline_m.size()];
      Patch side{.corners_m = {}, .num_corners = 4, .reflectivity = reflectivity, .is_filled_in = !is_measured[i]};
      side.corners_m[0] = site_point(a - up, prism.low_m);
      side.corners_m[1] = site_point(b - up, prism.low_m);
      side.corners_m[2] = site_point(b + up, prism.high_m);
      side.corners_m[3] = site_point(a + up, prism.high_m);
      sides_.push_back(side);
    }
  }

  const std::vector<Patch>& patches_;
  std::vector<Panorama>& scans_;
  const ThinObjectSettings& settings_;
  std::vector<Patch> sides_;
};

}  // namespace

std::vector<Patch> close_thin_objects(const std::vector<Patch>& patches, std::vector<Panorama>& scans,
                                      const ScannedGround& ground, const ThinObjectSettings& settings) {
  constexpr double kSteep = 0.7;
  std::map<int, std::vector<OutlinePoint>> layers;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Patch& patch = patches[i];
    const Eigen::Vector3d normal = patch.area_normal();
    if (patch.is_filled_in || std::abs(normal.z()) > kSteep * normal.norm()) continue;
    for (const Eigen::Vector3d& p : sample(patch, kSampleRatio * settings.cell_m)) {
      const double above_m = p.z() - ground.height_at(p.head<2>());
      if (above_m < settings.lowest_m || above_m > settings.highest_m) continue;
      layers[static_cast<int>(std::floor(p.z() / settings.layer_m))].push_back({p, i});
    }
  }
  ThinObjectCloser closer(patches, scans, settings);
  for (const auto& [index, points] : layers)
    closer.close_layer(points, index * settings.layer_m, settings.layer_m, settings.cell_m);
  return closer.take();
}

}  // namespace patrol::importer
