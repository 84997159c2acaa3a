#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/geometry/linear_algebra.h"
#include "importer/robot/source_reader.h"

namespace patrol::importer {
namespace {

constexpr double kMaxExcess = 0.1;         // of the largest moment over the sum of the others
constexpr double kRounding = 0.01;         // excess and negative moments of rounded numbers
constexpr double kMinSecondMoment = 5e-4;  // to their sum: no body is a line or a plane
constexpr double kTinyMass = 1e-2;         // to the mass of the robot
constexpr double kTinyMoment_m2 = 1e-6, kTinyMomentOfTinyMass_m2 = 1e-4;  // to the mass of the robot

/// Returns whether a body has these principal moments, in ascending order, up to rounding.
bool is_physical(const Eigen::Vector3d& moments) {
  const double max = moments.cwiseAbs().maxCoeff();
  if (max <= 1e-12) return true;
  return moments[0] >= -kRounding * max && moments[2] <= (1.0 + kRounding) * (moments[0] + moments[1]);
}

/// Returns the nearest inertia that a body has: the matrix of the second moments of its mass is made positive definite.
Eigen::Matrix3d nearest_physical(const Eigen::Matrix3d& inertia) {
  const Eigen::Matrix3d moments = 0.5 * inertia.trace() * Eigen::Matrix3d::Identity() - inertia;
  SymmetricEigen<3> eigen = symmetric_eigen(moments);
  const double sum = eigen.values.cwiseMax(0.0).sum();
  eigen.values = eigen.values.cwiseMax(kMinSecondMoment * sum);
  const Eigen::Matrix3d second = eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose();
  return second.trace() * Eigen::Matrix3d::Identity() - second;
}

std::string text_of(const Eigen::Vector3d& moments) {
  return fmt::format("{:.3g}, {:.3g} and {:.3g}", moments[0], moments[1], moments[2]);
}

}  // namespace

/// Replaces inertias that no body has by the nearest ones, if the difference is small or the link is negligible.
/// Refuses other ones.
void SourceReader::check_inertias() {
  double robot_kg = 0.0;
  for (const SourceLink& link : robot_.links) robot_kg += link.inertial ? link.inertial->mass_kg : 0.0;
  std::string negligible;
  double max_moment = 0.0;
  for (SourceLink& link : robot_.links) {
    if (!link.inertial || link.inertial->mass_kg <= 0.0) continue;
    const Eigen::Vector3d moments = symmetric_eigen(link.inertial->inertia).values;
    if (is_physical(moments)) continue;
    const double max = moments.cwiseAbs().maxCoeff();
    const bool is_tiny = max <= kTinyMoment_m2 * robot_kg ||
                         (link.inertial->mass_kg <= kTinyMass * robot_kg && max <= kTinyMomentOfTinyMass_m2 * robot_kg);
    if (!is_tiny && moments[2] > (1.0 + kMaxExcess) * (moments[0] + moments[1])) {
      robot_.fail(link.inertial->line, link.name,
                  fmt::format("invalid inertia: principal moments {} kg m2: the largest must not exceed the sum of the "
                              "others",
                              text_of(moments)));
    }
    link.inertial->inertia = nearest_physical(link.inertial->inertia);
    if (is_tiny) {
      negligible += (negligible.empty() ? "" : ", ") + link.name;
      max_moment = std::max(max_moment, max);
      continue;
    }
    robot_.assumptions.push_back(
        {.subject = link.name,
         .text =
             fmt::format("its principal moments of inertia {} kg m2 are replaced by {}: in a body, none exceeds the "
                         "sum of the others",
                         text_of(moments), text_of(symmetric_eigen(link.inertial->inertia).values)),
         .override_with = "<inertia> of the link"});
  }
  if (negligible.empty()) return;
  robot_.assumptions.push_back(
      {.subject = negligible,
       .text = fmt::format("no body has these inertias: replaced by the nearest possible ones; with moments of at most "
                           "{:.3g} kg m2 they are negligible in a robot of {:.3g} kg",
                           max_moment, robot_kg),
       .override_with = "<inertia> of the links"});
}

}  // namespace patrol::importer
