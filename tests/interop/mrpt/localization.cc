#include <cmath>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/random/RandomGenerators.h>

#include "conversions.h"
#include "core/geometry/angles.h"
#include "positioning.h"

namespace mrpt_stack {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr std::size_t kParticles = 600;
constexpr double kMinTravel_m = 0.1, kMinTurn_rad = 0.05;  ///< minimum motion between two updates by a scan

COccupancyGridMap2D::Ptr grid_of(const patrol::OccupancyGrid& map) {
  const patrol::GridGeometry& geometry = map.geometry();
  auto grid = COccupancyGridMap2D::Create();
  const auto resolution = static_cast<float>(geometry.resolution_m);
  const auto x = static_cast<float>(geometry.origin_m.x()), y = static_cast<float>(geometry.origin_m.y());
  grid->setSize(x, x + static_cast<float>(geometry.width) * resolution, y,
                y + static_cast<float>(geometry.height) * resolution, resolution);
  for (int row = 0; row < geometry.height; ++row) {
    for (int col = 0; col < geometry.width; ++col) {
      const int value = map.values()[static_cast<std::size_t>(row * geometry.width + col)];
      grid->setCell(col, row, value < 0 ? 0.5F : 1.0F - 0.01F * static_cast<float>(value));
    }
  }
  grid->likelihoodOptions.likelihoodMethod = COccupancyGridMap2D::lmLikelihoodField_Thrun;
  grid->likelihoodOptions.LF_stdHit = 0.15F;
  grid->likelihoodOptions.LF_zHit = 0.9F;
  grid->likelihoodOptions.LF_zRandom = 0.1F;
  grid->likelihoodOptions.LF_maxRange = 30.0F;
  grid->likelihoodOptions.LF_decimation = 8;
  grid->likelihoodOptions.LF_maxCorrsDistance = 0.5F;
  grid->likelihoodOptions.LF_alternateAverageMethod = false;
  return grid;
}

}  // namespace

Localization::Localization(const patrol::OccupancyGrid& map, const Pose2& T_map_start,
                           const patrol::Pose3& T_body_lidar, std::uint64_t seed)
    : map_(grid_of(map)), filter_(kParticles), T_body_lidar_(T_body_lidar), T_map_odom_(T_map_start) {
  mrpt::random::getRandomGenerator().randomize(static_cast<std::uint32_t>(seed));
  filter_.options.metricMap = map_;
  mrpt::random::CRandomGenerator& draw = mrpt::random::getRandomGenerator();
  filter_.resetDeterministic(to_plain(T_map_start), kParticles);
  for (auto& particle : filter_.m_particles) {
    particle.d.x += draw.drawGaussian1D(0.0, 0.1);
    particle.d.y += draw.drawGaussian1D(0.0, 0.1);
    particle.d.phi += draw.drawGaussian1D(0.0, 0.02);
  }
}

void Localization::update(const patrol::LaserScan& scan, const Odometry& odometry) {
  const Pose2& T_odom_body = odometry.pose();
  const Pose2 moved = last_T_odom_body_.inverse() * T_odom_body;
  if (moved.position().norm() < kMinTravel_m && std::abs(patrol::wrap_angle(moved.yaw)) < kMinTurn_rad) return;
  last_T_odom_body_ = T_odom_body;
  mrpt::obs::CActionRobotMovement2D::TMotionModelOptions motion;
  motion.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
  motion.gaussianModel.a1 = 0.03F;
  motion.gaussianModel.minStdXY = 0.003F;
  motion.gaussianModel.minStdPHI = 0.003F;
  mrpt::obs::CActionRobotMovement2D movement;
  movement.computeFromOdometry(to_mrpt(moved), motion);
  mrpt::obs::CActionCollection actions;
  actions.insert(movement);
  mrpt::obs::CSensoryFrame frame;
  frame.insert(mrpt::obs::CObservation2DRangeScan::Create(mrpt_stack::to_mrpt(scan, T_body_lidar_)));
  mrpt::bayes::CParticleFilter filter;
  filter.m_options.PF_algorithm = mrpt::bayes::CParticleFilter::pfStandardProposal;
  filter.m_options.adaptiveSampleSize = false;
  filter.m_options.resamplingMethod = mrpt::bayes::CParticleFilter::prSystematic;
  filter.executeOn(filter_, &actions, &frame);

  mrpt::poses::CPosePDFGaussian estimate;
  estimate.copyFrom(filter_);
  const mrpt::poses::CPose2D& mean = estimate.mean;
  T_map_odom_ = Pose2{mean.x(), mean.y(), mean.phi()} * T_odom_body.inverse();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) covariance_(i, j) = estimate.cov(i, j);
  }
}

}  // namespace mrpt_stack
