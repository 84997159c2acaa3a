#include "importer/site/points/post_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>

namespace patrol::importer {
namespace {

constexpr double kScale_m = 0.02;
constexpr double kMinHalf_m = 0.005, kMaxHalf_m = 0.9;
constexpr double kSlopeStep = 0.08, kMaxSlope = 0.6;
constexpr std::size_t kMinHits = 8;

template <typename Crossing>
double mean_cost(const std::vector<PlanBeam>& beams, double scale_m, Crossing crossing) {
  double sum = 0.0, count = 0.0;
  for (const PlanBeam& beam : beams) {
    const PlanCrossing c = crossing(beam);
    if (!beam.is_hit && c.clearance_m >= 0.0) continue;
    count += 1.0;
    if (!beam.is_hit || c.clearance_m > 0.0) {
      sum += std::min(1.0, std::abs(c.clearance_m) / scale_m);
    } else {
      const double depth = (beam.range_m - c.entry_m) / scale_m;
      sum += std::min(1.0, depth * depth);
    }
  }
  return count > 0.0 ? sum / count : 1.0;
}

/// Searches the minimum along each parameter, with steps that are halved.
template <std::size_t kSize, typename Cost>
double search(std::array<double, kSize>& parameters, std::array<double, kSize> steps, Cost cost) {
  constexpr int kHalvings = 5, kSweeps = 3;
  double best = cost(parameters);
  for (int halving = 0; halving < kHalvings; ++halving) {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      const double before = best;
      for (std::size_t i = 0; i < kSize; ++i) {
        for (const double sign : {1.0, -1.0}) {
          std::array<double, kSize> moved = parameters;
          moved[i] += sign * steps[i];
          const double value = cost(moved);
          if (value >= best) continue;
          best = value;
          parameters = moved;
          break;
        }
      }
      if (best >= before) break;
    }
    for (double& step : steps) step *= 0.5;
  }
  return best;
}

/// Returns the cost of a slope: upright posts are likely. 1 beyond the steepest one.
double cost_of_slope(double x, double y) {
  constexpr double kPerSlope = 0.05;
  const double slope = std::hypot(x, y);
  return slope > kMaxSlope ? 1.0 : kPerSlope * slope;
}

/// Returns the first step of the search for the slope; 0 if the beams are within too small a height.
double slope_step(const std::vector<PlanBeam>& beams) {
  constexpr double kMinHeight_m = 0.15;
  const auto [low, high] = std::minmax_element(
      beams.begin(), beams.end(), [](const PlanBeam& a, const PlanBeam& b) { return a.height_m < b.height_m; });
  return low != beams.end() && high->height_m - low->height_m > kMinHeight_m ? kSlopeStep : 0.0;
}

std::size_t num_hits(const std::vector<PlanBeam>& beams) {
  return static_cast<std::size_t>(
      std::count_if(beams.begin(), beams.end(), [](const PlanBeam& beam) { return beam.is_hit; }));
}

/// Searches with tolerances that become smaller, so that it finds the outline from afar.
template <std::size_t kSize, typename Cost>
double search_from_afar(std::array<double, kSize>& parameters, const std::array<double, kSize>& steps, Cost cost) {
  double best = 2.0;
  for (const double scale_m : {3.0 * kScale_m, kScale_m})
    best = search(parameters, steps, [&](const std::array<double, kSize>& p) { return cost(p, scale_m); });
  return best;
}

/// Rectangle: reference point, angle of its first axis, bounds along both axes from the reference point, and slope.
using RectangleParameters = std::array<double, 7>;

ConvexPolygon corners_of(const Eigen::Vector2d& reference, const RectangleParameters& r) {
  const Eigen::Vector2d x(std::cos(r[0]), std::sin(r[0])), y(-std::sin(r[0]), std::cos(r[0]));
  return {reference + r[1] * x + r[3] * y, reference + r[2] * x + r[3] * y, reference + r[2] * x + r[4] * y,
          reference + r[1] * x + r[4] * y};
}

/// Returns the center and the angle of the smallest rectangle around an outline, with its half sizes.
struct SmallestRectangle {
  Eigen::Vector2d center_m = Eigen::Vector2d::Zero(), half_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;
};

SmallestRectangle smallest_rectangle(const ConvexPolygon& outline_m) {
  SmallestRectangle best;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline_m.size(); ++i) {
    const Eigen::Vector2d x = (outline_m[(i + 1) % outline_m.size()] - outline_m[i]).normalized(), y(-x.y(), x.x());
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& corner : outline_m) box.extend(Eigen::Vector2d(x.dot(corner), y.dot(corner)));
    if (box.volume() >= smallest) continue;
    smallest = box.volume();
    best = {.center_m = box.center().x() * x + box.center().y() * y,
            .half_m = (0.5 * box.sizes()).cwiseMax(kMinHalf_m),
            .yaw_rad = std::atan2(x.y(), x.x())};
  }
  return best;
}

/// Circle: center, radius and slope.
using CircleParameters = std::array<double, 5>;

double cost_of_circle(const std::vector<PlanBeam>& beams, const CircleParameters& c, double scale_m) {
  if (c[2] < kMinHalf_m || c[2] > kMaxHalf_m) return 1.0;
  return mean_cost(beams, scale_m, [&](const PlanBeam& beam) {
    return crossing_of(beam, {c[0], c[1]}, c[2], {c[3], c[4]});
  });
}

/// Returns the circle through the returns, by least squares of the algebraic distance [Kasa76].
std::optional<CircleParameters> algebraic_circle(const std::vector<PlanBeam>& beams, const Eigen::Vector2d& middle_m) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const PlanBeam& beam : beams) {
    if (!beam.is_hit) continue;
    const Eigen::Vector2d p = beam.origin_m + beam.range_m * beam.direction - middle_m;
    const Eigen::Vector3d row(p.x(), p.y(), 1.0);
    A += row * row.transpose();
    b += p.squaredNorm() * row;
  }
  const Eigen::LDLT<Eigen::Matrix3d> ldlt(A);
  if (ldlt.info() != Eigen::Success || ldlt.rcond() < 1e-9) return std::nullopt;
  const Eigen::Vector3d x = ldlt.solve(b);
  const Eigen::Vector2d center = 0.5 * x.head<2>();
  const double radius2 = x[2] + center.squaredNorm();
  if (!(radius2 > 0.0)) return std::nullopt;
  return CircleParameters{center.x() + middle_m.x(), center.y() + middle_m.y(), std::sqrt(radius2), 0.0, 0.0};
}

}  // namespace

double cost_of(const std::vector<PlanBeam>& beams, const ConvexPolygon& outline_m) {
  return mean_cost(beams, kScale_m,
                   [&](const PlanBeam& beam) { return crossing_of(beam, outline_m, Eigen::Vector2d::Zero()); });
}

std::optional<FittedOutline> fit_circle(const std::vector<PlanBeam>& beams, const ConvexPolygon& outline_m) {
  if (num_hits(beams) < kMinHits || outline_m.size() < 3) return std::nullopt;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : outline_m) box.extend(corner);
  CircleParameters circle = {box.center().x(), box.center().y(), 0.25 * box.sizes().sum(), 0.0, 0.0};
  const std::optional<CircleParameters> algebraic = algebraic_circle(beams, box.center());
  if (algebraic && cost_of_circle(beams, *algebraic, kScale_m) < cost_of_circle(beams, circle, kScale_m))
    circle = *algebraic;
  const double step_m = 0.25 * circle[2];
  FittedOutline fitted;
  fitted.cost =
      search_from_afar(circle, {step_m, step_m, step_m, slope_step(beams), slope_step(beams)},
                       [&](const CircleParameters& c, double scale_m) { return cost_of_circle(beams, c, scale_m); });
  fitted.slope = {circle[3], circle[4]};
  constexpr int kCorners = 16;
  // The polygon's mean width is the diameter.
  const double radius_m = circle[2] * std::numbers::pi / kCorners / std::sin(std::numbers::pi / kCorners);
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    fitted.outline_m.emplace_back(circle[0] + radius_m * std::cos(angle), circle[1] + radius_m * std::sin(angle));
  }
  return fitted;
}

std::optional<FittedOutline> fit_rectangle(const std::vector<PlanBeam>& beams, const ConvexPolygon& outline_m) {
  if (num_hits(beams) < kMinHits || outline_m.size() < 3) return std::nullopt;
  const SmallestRectangle around = smallest_rectangle(outline_m);
  RectangleParameters rectangle = {
      around.yaw_rad, -around.half_m.x(), around.half_m.x(), -around.half_m.y(), around.half_m.y(), 0.0, 0.0};
  FittedOutline fitted;
  fitted.cost =
      search_from_afar(rectangle, {0.1, 0.016, 0.016, 0.016, 0.016, slope_step(beams), slope_step(beams)},
                       [&](const RectangleParameters& r, double scale_m) {
                         const double smaller = std::min(r[2] - r[1], r[4] - r[3]),
                                      larger = std::max(r[2] - r[1], r[4] - r[3]);
                         if (smaller < 2.0 * kMinHalf_m || larger > 2.0 * kMaxHalf_m) return 1.0;
                         const ConvexPolygon corners = corners_of(around.center_m, r);
                         return cost_of_slope(r[5], r[6]) + mean_cost(beams, scale_m, [&](const PlanBeam& beam) {
                                  return crossing_of(beam, corners, {r[5], r[6]});
                                });
                       });
  fitted.outline_m = corners_of(around.center_m, rectangle);
  fitted.slope = {rectangle[5], rectangle[6]};
  return fitted;
}

}  // namespace patrol::importer
