#include "localize/dock_detector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/linear_algebra.h"
#include "core/geometry/segment.h"

namespace patrol::localize {
namespace {

constexpr double kCutoffSigma = 4.0;    // cutoff of a beam error in standard deviations
constexpr double kCoarseWidth_m = 0.2;  // cutoff of the support during the coarse search
constexpr int kCoarseSteps = 2;         // coarse steps to each side of the expected pose
constexpr std::size_t kNumCandidates = 4;
constexpr double kFineStep_m = 0.02;
constexpr double kFinest_m = 0.0005;
// Ratio of the yaw step to the position step of the search, for half the width of a post.
constexpr double kRadPerMeter = 4.0;
// Maximum standard deviation in search coordinates; larger values mean a degenerate direction.
constexpr double kMaxStd_m = 0.05;

}  // namespace

DockDetector::DockDetector(const DockDetectorSettings& settings, std::vector<Eigen::Vector2d> profile_m)
    : settings_(settings), profile_m_(std::move(profile_m)) {
  validate(settings_, "docking.detector");
  if (profile_m_.size() < 2) {
    throw InputError(fmt::format("dock profile: {} points: must be at least 2", profile_m_.size()));
  }
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : profile_m_) box.extend(p);
  middle_m_ = box.center();
  radius_m_ = box.diagonal().norm() / 2.0;
}

std::optional<DockDetection> DockDetector::detect(const LevelScan& scan, const Pose2& T_level_expected) const {
  if ((T_level_expected * middle_m_ - scan.origin_m).norm() > settings_.max_range_m) return std::nullopt;
  const std::vector<Beam> beams = beams_about(scan, T_level_expected);
  if (static_cast<int>(beams.size()) < settings_.min_beams) return std::nullopt;
  const std::vector<Beam> hits = hits_near(beams, scan.origin_m, T_level_expected);
  Fit fit = refine(hits, scan.origin_m, T_level_expected);
  DockDetection detection{.stamp = scan.stamp, .T_level_docked = fit.T_level_docked};
  if (!accept(beams, scan.origin_m, detection)) {  // not at the expected pose: search around it
    fit = search(hits, scan.origin_m, T_level_expected);
    detection.T_level_docked = fit.T_level_docked;
    if (!accept(beams, scan.origin_m, detection)) return std::nullopt;
  }
  const std::optional<Eigen::Matrix3d> spread = covariance(hits, scan.origin_m, fit);
  if (!spread) return std::nullopt;
  detection.covariance = *spread;
  return detection;
}

double DockDetector::max_beam_distance_m() const {
  return radius_m_ + settings_.search_m * std::sqrt(2.0) + settings_.end_clearance_m;
}

// Returns the beams that could hit the post anywhere in the search range, and those that pass its ends.
std::vector<DockDetector::Beam> DockDetector::beams_about(const LevelScan& scan, const Pose2& T_level_expected) const {
  const Eigen::Vector2d to_post = T_level_expected * middle_m_ - scan.origin_m;
  std::vector<Beam> beams;
  for (const LevelScan::Beam& beam : scan.beams) {
    const Eigen::Vector2d along = beam.end_m.cast<double>() - scan.origin_m;
    const double range_m = along.norm();
    if (range_m < 1e-3) continue;
    const Eigen::Vector2d direction = along / range_m;
    const double ahead_m = direction.dot(to_post);
    const double aside_m = std::abs(direction.x() * to_post.y() - direction.y() * to_post.x());
    if (ahead_m > -max_beam_distance_m() && aside_m < max_beam_distance_m())
      beams.push_back({direction, range_m, beam.is_hit});
  }
  return beams;
}

// Returns the hits near the post, the only beams that can support a pose.
std::vector<DockDetector::Beam> DockDetector::hits_near(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m,
                                                        const Pose2& T_level_expected) const {
  const Eigen::Vector2d middle = T_level_expected * middle_m_;
  std::vector<Beam> hits;
  for (const Beam& beam : beams) {
    const double distance_m = (origin_m + beam.range_m * beam.direction - middle).norm();
    if (beam.is_hit && distance_m < max_beam_distance_m() + kCoarseWidth_m) hits.push_back(beam);
  }
  return hits;
}

double DockDetector::cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < profile_m_.size(); ++i) {
    // origin + s direction = a + u (b - a)
    const Eigen::Vector2d to_a = profile_m_[i] - origin, ab = profile_m_[i + 1] - profile_m_[i];
    const double cross = direction.x() * ab.y() - direction.y() * ab.x();
    if (cross == 0.0) continue;
    const double s = (to_a.x() * ab.y() - to_a.y() * ab.x()) / cross;
    const double u = (to_a.x() * direction.y() - to_a.y() * direction.x()) / cross;
    if (s > 0.0 && u >= 0.0 && u <= 1.0) nearest = std::min(nearest, s);
  }
  return nearest;
}

double DockDetector::support(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m,
                             const Pose2& T_level_docked, double width_m) const {
  const Pose2 T_docked_level = T_level_docked.inverse();
  const Eigen::Vector2d origin = T_docked_level * origin_m;
  const double c = std::cos(T_docked_level.yaw), s = std::sin(T_docked_level.yaw);
  double total = 0.0;
  for (const Beam& beam : beams) {
    const Eigen::Vector2d direction(c * beam.direction.x() - s * beam.direction.y(),
                                    s * beam.direction.x() + c * beam.direction.y());
    const double error = (beam.range_m - cast(origin, direction)) / width_m;
    total += std::max(0.0, 1.0 - error * error);
  }
  return total;
}

/// Translates the pose in level, or rotates it about the center of the outline. A rotation about the docked body, half
/// a meter away, would also shift the outline. The coordinate search would then follow a narrow ridge in small steps.
Pose2 DockDetector::step_pose(const Pose2& T_level_docked, int axis, double step_m) const {
  if (axis == 0) return {T_level_docked.x + step_m, T_level_docked.y, T_level_docked.yaw};
  if (axis == 1) return {T_level_docked.x, T_level_docked.y + step_m, T_level_docked.yaw};
  const Pose2 T_docked_middle{middle_m_.x(), middle_m_.y(), 0.0};
  return T_level_docked * T_docked_middle * Pose2{0.0, 0.0, kRadPerMeter * step_m} * T_docked_middle.inverse();
}

DockDetector::Fit DockDetector::search(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m,
                                       const Pose2& T_level_expected) const {
  std::vector<Fit> candidates;
  for (int i = -kCoarseSteps; i <= kCoarseSteps; ++i) {
    for (int j = -kCoarseSteps; j <= kCoarseSteps; ++j) {
      for (int k = -kCoarseSteps; k <= kCoarseSteps; ++k) {
        const double step_m = settings_.search_m / kCoarseSteps, step_rad = settings_.search_rad / kCoarseSteps;
        const Pose2 rotated = step_pose(T_level_expected, 2, k * step_rad / kRadPerMeter);
        const Pose2 T = step_pose(step_pose(rotated, 0, i * step_m), 1, j * step_m);
        candidates.push_back({T, support(beams, origin_m, T, kCoarseWidth_m)});
      }
    }
  }
  const auto has_more = [](const Fit& a, const Fit& b) { return a.support > b.support; };
  std::stable_sort(candidates.begin(), candidates.end(), has_more);
  candidates.resize(kNumCandidates);
  for (Fit& fit : candidates) {
    climb(beams, origin_m, kCoarseWidth_m, settings_.search_m / (2.0 * kCoarseSteps), fit);
    fit = refine(beams, origin_m, fit.T_level_docked);
  }
  return *std::min_element(candidates.begin(), candidates.end(), has_more);
}

/// Refines a pose with an error of a few centimeters.
DockDetector::Fit DockDetector::refine(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m,
                                       const Pose2& T_level_docked) const {
  const double width_m = kCutoffSigma * settings_.range_std_m;
  Fit fit{T_level_docked, support(beams, origin_m, T_level_docked, width_m)};
  climb(beams, origin_m, width_m, kFineStep_m, fit);
  return fit;
}

/// Pattern search: takes each step along an axis that increases the support, and halves the step size when none does.
void DockDetector::climb(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, double width_m, double step_m,
                         Fit& fit) const {
  while (step_m >= kFinest_m) {
    bool has_gained = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        const Pose2 there = step_pose(fit.T_level_docked, axis, sign * step_m);
        const double gained = support(beams, origin_m, there, width_m);
        if (gained <= fit.support) continue;
        fit = {there, gained};
        has_gained = true;
      }
    }
    if (!has_gained) step_m /= 2.0;
  }
}

// Near its maximum the support is N - sum(error^2) / w^2, so its second differences give the information, sum(J^T J) /
// sigma^2. The step equals the noise, in order to include the information of the edges.
std::optional<Eigen::Matrix3d> DockDetector::covariance(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m,
                                                        const Fit& fit) const {
  const double width_m = kCutoffSigma * settings_.range_std_m, step_m = settings_.range_std_m;
  const auto loss = [&](int a, double step_a, int b, double step_b) {
    return -support(beams, origin_m, step_pose(step_pose(fit.T_level_docked, a, step_a), b, step_b), width_m);
  };
  Eigen::Matrix3d curvature;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      const double d = a == b ? step_m / 2.0 : step_m;
      curvature(a, b) = (loss(a, d, b, d) - loss(a, d, b, -d) - loss(a, -d, b, d) + loss(a, -d, b, -d)) / (4.0 * d * d);
    }
  }
  const double w_per_std = width_m / settings_.range_std_m;
  const Eigen::Matrix3d information = 0.25 * w_per_std * w_per_std * (curvature + curvature.transpose());
  const SymmetricEigen<3> eigen = symmetric_eigen(information);
  if (eigen.values.minCoeff() < 1.0 / (kMaxStd_m * kMaxStd_m)) return std::nullopt;

  // Transform from search coordinates to x, y, yaw of the docked body: a rotation about the center moves it.
  const Eigen::Vector2d arm = fit.T_level_docked.position() - fit.T_level_docked * middle_m_;
  Eigen::Matrix3d J;
  J << 1.0, 0.0, -kRadPerMeter * arm.y(), 0.0, 1.0, kRadPerMeter * arm.x(), 0.0, 0.0, kRadPerMeter;
  return J * information.inverse() * J.transpose();
}

/// Evaluates a detection: inlier ratio over the predicted beams, with free space next to the post. Sets the quality
/// fields and returns whether the detection is accepted.
bool DockDetector::accept(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m,
                          DockDetection& detection) const {
  const Pose2 T_docked_level = detection.T_level_docked.inverse();
  const Eigen::Vector2d origin = T_docked_level * origin_m;
  const double width_m = kCutoffSigma * settings_.range_std_m;
  int num_inliers = 0, num_outliers = 0;
  double squares = 0.0;
  for (const Beam& beam : beams) {
    const Eigen::Vector2d end = T_docked_level * Eigen::Vector2d(origin_m + beam.range_m * beam.direction);
    const double should_m = cast(origin, (end - origin) / beam.range_m);
    const double error = beam.range_m - should_m;
    if (std::isfinite(should_m)) {
      const bool is_met = beam.is_hit && std::abs(error) <= width_m;
      if (is_met) {
        ++num_inliers;
        squares += error * error;
      } else {
        ++num_outliers;
      }
    } else if (beam.is_hit) {
      double distance_m = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i + 1 < profile_m_.size(); ++i) {
        distance_m = std::min(distance_m, distance_to_segment(end, profile_m_[i], profile_m_[i + 1]));
      }
      if (distance_m < settings_.end_clearance_m) ++num_outliers;
    }
  }
  if (num_inliers < settings_.min_beams) return false;
  detection.inlier_ratio = static_cast<double>(num_inliers) / (num_inliers + num_outliers);
  detection.rms_m = std::sqrt(squares / num_inliers);
  return detection.inlier_ratio >= settings_.min_inlier_ratio && detection.rms_m <= settings_.max_rms_m;
}

}  // namespace patrol::localize
