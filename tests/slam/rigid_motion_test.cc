#include "slam/rigid_motion.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::slam::rigid_motion_test {
namespace {

using Points = std::vector<Eigen::Vector2d>;
using test::Pose2Near;

constexpr double kExactTol = 1e-12;

TEST(FitRigidMotion, RecoversAMotionExactly) {
  const Points source = {{1.0, 2.0}, {-4.0, 0.5}, {3.0, -2.5}, {12.0, 7.0}, {-1.0, -9.0}};
  for (const Pose2& T : {Pose2{3.0, -2.0, 0.7}, Pose2{0.0, 0.0, 3.1}, Pose2{-100.0, 50.0, -2.0}}) {
    Points target;
    for (const auto& p : source) target.push_back(T * p);
    EXPECT_THAT(fit_rigid_motion(target, source), Pose2Near(T, 1e-12 * 100.0, kExactTol));
  }
  EXPECT_THAT(fit_rigid_motion({{3.0, 4.0}}, {{1.0, 1.0}}), Pose2Near((Pose2{2.0, 3.0, 0.0}), kExactTol, kExactTol))
      << "one pair says no angle";
}

// No pose around has a smaller sum: the closed form is the least squares of eq. 9.
TEST(FitRigidMotion, IsTheLeastSquaresMotion) {
  const Points target{{0.0, 0.0}, {2.0, 0.3}, {1.0, 3.0}, {-1.0, 1.0}},
      source{{0.2, 0.1}, {1.9, 0.0}, {1.3, 2.7}, {-1.2, 0.8}};
  const auto loss = [&](const Pose2& T) {
    double sum = 0.0;
    for (std::size_t i = 0; i < target.size(); ++i) sum += (T * source[i] - target[i]).squaredNorm();
    return sum;
  };
  const Pose2 best = fit_rigid_motion(target, source);
  for (const Eigen::Vector3d& d : {Eigen::Vector3d(1e-3, 0, 0), {0, 1e-3, 0}, {0, 0, 1e-3}}) {
    EXPECT_GT(loss({best.x + d.x(), best.y + d.y(), best.yaw + d.z()}), loss(best));
    EXPECT_GT(loss({best.x - d.x(), best.y - d.y(), best.yaw - d.z()}), loss(best));
  }
}

}  // namespace
}  // namespace patrol::slam::rigid_motion_test
