#include "slam/graph/edge_weight.h"

#include <gtest/gtest.h>

namespace patrol::slam::edge_weight_test {
namespace {

TEST(EdgeInformation, AMatchOfCountlessPointsIsAsSureAsItsSystematicError) {
  const Eigen::Matrix3d information = edge_information(1e12 * Eigen::Matrix3d::Identity(), 0.02, 0.002);
  EXPECT_NEAR(information(0, 0), 1.0 / (0.02 * 0.02), 1.0);
  EXPECT_NEAR(information(2, 2), 1.0 / (0.002 * 0.002), 100.0);
}

TEST(EdgeInformation, WhereTheMatchSaysNothingTenMetersAreLeftOpen) {
  Eigen::Matrix3d corridor = Eigen::Matrix3d::Zero();
  corridor(1, 1) = corridor(2, 2) = 1e6;
  const Eigen::Matrix3d information = edge_information(corridor, 0.02, 0.002);
  EXPECT_NEAR(information(0, 0), 0.01, 1e-6);
  EXPECT_GT(information(1, 1), 2000.0);
}

TEST(EdgeInformation, IsSymmetricAndPositive) {
  Eigen::Matrix3d match;
  match << 900.0, 300.0, 20.0, 300.0, 400.0, -50.0, 20.0, -50.0, 8000.0;
  const Eigen::Matrix3d information = edge_information(match, 0.05, 0.01);
  EXPECT_EQ(information, information.transpose());
  EXPECT_GT(information.determinant(), 0.0);
}

}  // namespace
}  // namespace patrol::slam::edge_weight_test
