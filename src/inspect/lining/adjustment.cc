#include "inspect/lining/adjustment.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

#include <Eigen/Cholesky>

#include "core/geometry/angles.h"
#include "inspect/lining/registration.h"
#include "inspect/lining/robust_mean.h"

namespace patrol::inspect {
namespace {

constexpr int kMaxAssociations = 6;  // maximum number of patch associations
// Convergence limit of a step, and the distance at which its rotation counts.
constexpr double kConverged_m = 2e-5, kFar_m = 10.0;
constexpr double kMinCutoff_m = 0.003;      // minimum cutoff within a cell, because a bulge is not flat
constexpr double kPatch_m = 0.5;            // patch size of surfaces other than the lining
constexpr double kFixtureDistance_m = 0.1;  // points closer to the design are the lining or flat fixtures on it
constexpr double kPartner_m = 0.15, kFixtureBand_m = 0.03, kFacing = 0.8;
constexpr int kMinPatchPoints = 5;
// Normal components along the tunnel up to this value are treated as noise and removed. Otherwise thousands of wall
// points would constrain the position along the tunnel with that noise.
constexpr double kMinAlong = 0.3;
constexpr double kMaxCount = 8.0;  // more points do not improve a mean: the remaining error is texture

struct Samples {
  std::vector<double> offsets_m, weights;
  std::vector<Vector7> J;
  int points = 0;

  void add(double offset_m, const Vector7& derivative, int count) {
    offsets_m.push_back(offset_m);
    weights.push_back(std::min(kMaxCount, static_cast<double>(count)));
    J.push_back(derivative);
    points += count;
  }
};

Vector7 derivative(const Eigen::Vector3d& normal, const Eigen::Vector3d& arm) {
  Vector7 J;
  // A range that is too long by the offset moves its point outward by the same amount.
  J << normal, arm.cross(normal), -normal.dot(arm.normalized());
  return J;
}

Patch patch_of(const Samples& samples, int cell, double extra_var_m2) {
  const RobustMean mean = robust_mean(samples.offsets_m, samples.weights, kMinCutoff_m);
  Patch patch{.cell = cell, .offset_m = mean.mean, .var_m2 = mean.var + extra_var_m2, .points = samples.points};
  for (std::size_t i = 0; i < samples.J.size(); ++i) {
    patch.J += mean.weights[i] * samples.J[i];
    patch.square_m2 += mean.weights[i] * (samples.offsets_m[i] - mean.mean) * (samples.offsets_m[i] - mean.mean);
  }
  return patch;
}

/// Identifies a patch of a surface other than the lining: grid cell and dominant axis of the normal.
using PatchKey = std::tuple<std::int64_t, std::int64_t, std::int64_t, Eigen::Index>;

PatchKey patch_key(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const auto voxel = [&](Eigen::Index i) { return static_cast<std::int64_t>(std::floor(p[i] / kPatch_m)); };
  return {voxel(0), voxel(1), voxel(2), axis};
}

class Adjuster {
 public:
  Adjuster(const LiningInMap& lining, const LiningGrid& grid, const ReferenceLining& reference,
           const SurfaceCloud& target_map, const SurfaceCloud& source, const Pose3& guess,
           const LiningSettings& settings)
      : lining_(lining),
        grid_(grid),
        reference_(reference),
        target_(target_map),
        source_(source),
        guess_(guess),
        settings_(settings) {
    const double heading = lining.design.heading_at(lining.design.to_tunnel_coordinates(guess.position).chainage_m);
    axis_map_ = {std::cos(heading), std::sin(heading), 0.0};
  }

  std::vector<Patch> patches(const Pose3& T_map_scanner, double range_offset_m) const {
    std::vector<Samples> cells(static_cast<std::size_t>(grid_.cells()));
    std::map<PatchKey, Samples> others;
    for (std::size_t i = 0; i < source_.points().size(); ++i) {
      const DownsampledPoint& sample = source_.points()[i];
      const Eigen::Vector3d arm = T_map_scanner.rotation * (sample.p - range_offset_m * sample.p.normalized());
      const Eigen::Vector3d p = T_map_scanner.position + arm;
      const LiningPoint point = lining_point(lining_, p);
      const bool is_near_lining = std::abs(point.inward_m) < kFixtureDistance_m &&
                                  std::abs(point.clock_deg) < (grid_.half_sectors + 0.5) * grid_.sector_deg;
      if (is_near_lining) {
        const int cell = grid_.cell_at(point);
        if (cell < 0) continue;
        const auto before_m = reference_.inward_m(point, cell);
        if (!before_m || std::abs(point.inward_m - *before_m) > settings_.design_tolerance_m) continue;
        cells[static_cast<std::size_t>(cell)].add(point.inward_m - *before_m, derivative(point.gradient, arm),
                                                  sample.count);
      } else {
        add_other(i, p, arm, T_map_scanner, others);
      }
    }
    return means(cells, others);
  }

  /// Computes one least-squares step over the patches, with the biweights iterated to convergence.
  Vector7 solve(const std::vector<Patch>& patches, Adjustment& state) const {
    const Vector7 from_guess = offset_from_guess(state);
    Vector7 prior;
    prior.head<3>().setConstant(1.0 / (settings_.prior_std_m * settings_.prior_std_m));
    const double guess_std_rad = to_rad(settings_.prior_std_deg);
    prior.segment<3>(3).setConstant(1.0 / (guess_std_rad * guess_std_rad));
    prior[6] = 1.0 / (settings_.range_offset_std_m * settings_.range_offset_std_m);
    Vector7 step = Vector7::Zero();
    state.weights.assign(patches.size(), 1.0);
    for (int iteration = 0; iteration < 15; ++iteration) {
      std::vector<double> ratios, lining_ratios;
      for (const Patch& patch : patches) {
        ratios.push_back((patch.offset_m + patch.J.dot(step)) / std::sqrt(patch.var_m2));
        if (patch.cell >= 0) lining_ratios.push_back(ratios.back());
      }
      state.scale = std::max(1.0, mad_std(lining_ratios, 0.0));
      Matrix7 H = prior.asDiagonal();
      Vector7 b = prior.cwiseProduct(from_guess);
      for (std::size_t i = 0; i < patches.size(); ++i) {
        state.weights[i] = biweight(ratios[i], kBiweightCutoff * state.scale);
        const double weight = state.weights[i] / (patches[i].var_m2 * state.scale * state.scale);
        H += weight * patches[i].J * patches[i].J.transpose();
        b += weight * patches[i].offset_m * patches[i].J;
      }
      const Eigen::LDLT<Matrix7> factors = H.ldlt();
      const Vector7 before = step;
      step = -factors.solve(b);
      state.covariance = factors.solve(Matrix7::Identity());
      if ((step - before).norm() < 1e-7) break;
    }
    return step;
  }

 private:
  void add_other(std::size_t i, const Eigen::Vector3d& p, const Eigen::Vector3d& arm, const Pose3& T_map_scanner,
                 std::map<PatchKey, Samples>& others) const {
    const Eigen::Vector3d normal = T_map_scanner.rotation * source_.surfaces()[i].normal;
    if (normal.isZero()) return;
    const auto near = target_.nearest(p, 1);
    if (near.count == 0 || near.squared_m2[0] > kPartner_m * kPartner_m) return;
    const SurfaceCloud::Surface& surface = target_.surfaces()[near.index[0]];
    const double offset_m = surface.normal.dot(p - surface.mean);
    if (std::abs(surface.normal.dot(normal)) < kFacing || std::abs(offset_m) > kFixtureBand_m) return;
    const double side = surface.normal.dot(arm) > 0.0 ? -1.0 : 1.0;  // toward the scanner
    const double along = surface.normal.dot(axis_map_);
    const Eigen::Vector3d held =
        std::abs(along) < kMinAlong ? Eigen::Vector3d(surface.normal - along * axis_map_) : surface.normal;
    others[patch_key(surface.mean, surface.normal)].add(side * offset_m, derivative(side * held, arm),
                                                        source_.points()[i].count);
  }

  std::vector<Patch> means(const std::vector<Samples>& cells, const std::map<PatchKey, Samples>& others) const {
    std::vector<Patch> patches;
    for (int cell = 0; cell < grid_.cells(); ++cell) {
      const Samples& samples = cells[static_cast<std::size_t>(cell)];
      if (static_cast<int>(samples.J.size()) < settings_.min_points || reference_.points(cell) < settings_.min_points)
        continue;
      patches.push_back(
          patch_of(samples, cell, reference_.var_m2(cell) + settings_.surface_std_m * settings_.surface_std_m));
    }
    for (const auto& [key, samples] : others) {
      if (static_cast<int>(samples.J.size()) < kMinPatchPoints) continue;
      patches.push_back(patch_of(samples, -1, settings_.fixture_std_m * settings_.fixture_std_m));
    }
    return patches;
  }

  Vector7 offset_from_guess(const Adjustment& state) const {
    const Eigen::AngleAxisd turn(state.T_map_scanner.rotation * guess_.rotation.conjugate());
    Vector7 offset;
    offset << state.T_map_scanner.position - guess_.position, turn.angle() * turn.axis(), state.range_offset_m;
    return offset;
  }

  const LiningInMap& lining_;
  const LiningGrid& grid_;
  const ReferenceLining& reference_;
  const SurfaceCloud &target_, &source_;
  Pose3 guess_;
  Eigen::Vector3d axis_map_;  ///< tunnel axis at the scanner
  const LiningSettings& settings_;
};

double rms_of(const Adjustment& result) {
  double squares = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < result.patches.size(); ++i) {
    const Patch& patch = result.patches[i];
    squares += result.weights[i] * patch.points * (patch.square_m2 + patch.offset_m * patch.offset_m);
    sum += result.weights[i] * patch.points;
  }
  return sum > 0.0 ? std::sqrt(squares / sum) : 0.0;
}

}  // namespace

Adjustment adjust(const LiningInMap& lining, const LiningGrid& grid, const ReferenceLining& reference,
                  const SurfaceCloud& target_map, const SurfaceCloud& source, const Pose3& T_map_scanner_start,
                  const Pose3& T_map_scanner_guess, const LiningSettings& settings) {
  const Adjuster adjuster(lining, grid, reference, target_map, source, T_map_scanner_guess, settings);
  Adjustment result;
  result.T_map_scanner = T_map_scanner_start;
  const double angle_std_rad = settings.angle_std_arcsec / 3600.0 * kDegree;
  result.angle_var_rad2 = 2.0 * angle_std_rad * angle_std_rad;
  for (int association = 0;; ++association) {
    result.patches = adjuster.patches(result.T_map_scanner, result.range_offset_m);
    const Vector7 step = adjuster.solve(result.patches, result);
    // Leave the loop before the pose changes: the final patches belong to the final pose.
    if (association == kMaxAssociations ||
        step.head<3>().norm() + kFar_m * step.segment<3>(3).norm() + std::abs(step[6]) < kConverged_m)
      break;
    result.T_map_scanner = apply_step(result.T_map_scanner, step.head<6>());
    result.range_offset_m += step[6];
  }
  result.rms_m = rms_of(result);
  return result;
}

}  // namespace patrol::inspect
