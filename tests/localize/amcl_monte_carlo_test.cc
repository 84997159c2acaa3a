#include "localize/amcl/monte_carlo.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "tests/support/pose_near.h"
#include "tests/support/tunnel_world.h"

namespace patrol::localize {
namespace {

using test::DriveSettings, test::Tunnel, test::TunnelDrive;

const Pose3 kAntenna{{-0.2, 0.1, 0.3}, Eigen::Quaterniond::Identity()};
const Eigen::Matrix3d kStart = Eigen::Vector3d(0.04, 0.04, 0.003).asDiagonal();

TEST(Study, Drive) {
  const Tunnel tunnel;
  MonteCarloSettings settings; if (getenv("IB")) settings.independent_beams = atof(getenv("IB")); if (getenv("TOL")) settings.scan_fit_tol = atof(getenv("TOL")); if (getenv("MF")) settings.refinement.min_facing = atof(getenv("MF"));
  MonteCarloLocalizer localizer(settings, test::tunnel_map(), tunnel.anchors(), kAntenna, 1);
  TunnelDrive drive(tunnel.world, tunnel.anchors(), kAntenna, {getenv("X0") ? atof(getenv("X0")) : 0.0, 0.0, 0.0}, {.way_scale_error = getenv("SCALE") ? atof(getenv("SCALE")) : 0.02}, getenv("SEED") ? atoi(getenv("SEED")) : 1);
  const bool uwb = getenv("UWB") != nullptr;
  if (getenv("ANY")) localizer.start_anywhere(); else
  localizer.start_at({0.1, -0.1, 0.03}, kStart);
  for (int i = 0; i < 1300; ++i) {
    if (uwb) for (const UwbRange& range : drive.ranges()) localizer.add(range, to_spatial(drive.T_odom_body()));
    const LocalizationUpdate update = localizer.update(drive.scan(), drive.T_odom_body());
    const Pose2 e = drive.T_map_body().inverse() * update.estimate.T_map_body;
    if (i < 10 || i % 25 == 0 || (i > 395 && i < 450 && i % 2 == 0)) std::printf("x %6.2f  err %7.3f %7.3f %6.2f deg  std %6.3f %6.3f %6.3f deg  trust %.2f lost %d n %d clump %.2f match %.2f inj %d\n", drive.T_map_body().x, e.x, e.y, e.yaw * 57.3,
      std::sqrt(update.estimate.covariance(0,0)), std::sqrt(update.estimate.covariance(1,1)), 57.3*std::sqrt(update.estimate.covariance(2,2)), update.trust.trust, update.trust.is_lost, update.num_particles, update.clump_weight, update.matched_share, update.num_injected);
    if (getenv("KID") && i == 400) drive.kidnap_to({drive.T_map_body().x + atof(getenv("KID")), 0.3, 0.02}), std::printf("KIDNAP\n");
    drive.step();
  }
}

}  // namespace
}  // namespace patrol::localize
