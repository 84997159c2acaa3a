#include "inspect/lining/registration.h"

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/support/lined_tunnel.h"

namespace patrol::inspect::registration_test {
namespace {

SurfaceCloud scan_from(const test::LinedTunnel& tunnel, const Pose3& T_route_scanner, std::uint64_t seed) {
  return SurfaceCloud(downsample(tunnel.scan(T_route_scanner, {.step_deg = 1.0}, seed).points, 0.1, 1.5));
}

/// 0.3 m along and aside, 6 cm up and 2 degrees off, to either side.
TEST(Registration, Start300mmAnd2DegreesOffEndsWithin10mm) {
  const test::LinedTunnel tunnel = test::LinedTunnel().furnish();
  const Pose3 T_route_first{{35.0, -2.2, 0.85}, quaternion_from_yaw(0.1)},
      T_route_second{{35.1, -2.0, 0.85}, quaternion_from_yaw(-0.1)};
  const SurfaceCloud target = scan_from(tunnel, T_route_first, 1), source = scan_from(tunnel, T_route_second, 2);
  const Pose3 truth = T_route_first.inverse() * T_route_second;
  for (const double sign : {-1.0, 1.0}) {
    const Pose3 start{truth.position + sign * Eigen::Vector3d(0.3, 0.3, 0.06),
                      quaternion_from_yaw(2.0 * kDegree * sign) * truth.rotation};
    const Registration found = register_cloud(target, source, start, {});
    EXPECT_TRUE(found.converged);
    EXPECT_GT(found.inlier_ratio, 0.85);
    EXPECT_LT((found.T_target_source.position - truth.position).norm(), 0.01);
    EXPECT_LT(found.T_target_source.rotation.angularDistance(truth.rotation), 0.1 * kDegree);
  }
}

TEST(Registration, TruckInOneScanDoesNotPullByMoreThan10mm) {
  test::LinedTunnel tunnel = test::LinedTunnel().furnish();
  const Pose3 T_route_scanner{{35.0, -2.2, 0.85}, quaternion_from_yaw(0.0)};
  const SurfaceCloud target = scan_from(tunnel, T_route_scanner, 1),
                     source = scan_from(tunnel.park_truck(39.0, 1.5), T_route_scanner, 2);
  const Registration found = register_cloud(target, source, {{0.2, -0.1, 0.03}, quaternion_from_yaw(kDegree)}, {});
  EXPECT_TRUE(found.converged);
  EXPECT_LT(found.T_target_source.position.norm(), 0.01);
}

TEST(Registration, OfNothingFails) {
  const SurfaceCloud nothing({}),
      cloud = scan_from(test::LinedTunnel(), {{35.0, 0.0, 0.85}, Eigen::Quaterniond::Identity()}, 1);
  EXPECT_FALSE(register_cloud(nothing, cloud, {}, {}).converged);
  EXPECT_FALSE(register_cloud(cloud, nothing, {}, {}).converged);
}

TEST(Moved, StepTurnsAboutTheSourcesOriginAndShiftsIt) {
  Eigen::Matrix<double, 6, 1> step;
  step << 1.0, 2.0, 3.0, 0.0, 0.0, 90.0 * kDegree;
  const Pose3 T = apply_step({{5.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()}, step);
  EXPECT_TRUE(T.position.isApprox(Eigen::Vector3d(6.0, 2.0, 3.0), 1e-12));
  EXPECT_TRUE((T * Eigen::Vector3d(1.0, 0.0, 0.0)).isApprox(Eigen::Vector3d(6.0, 3.0, 3.0), 1e-12));
}

}  // namespace
}  // namespace patrol::inspect::registration_test
