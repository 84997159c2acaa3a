#include "inspect/lining/axial_overlap.h"

#include <gtest/gtest.h>

#include "tests/support/lined_tunnel.h"

namespace patrol::inspect::grip_test {
namespace {

SurfaceCloud scan(const test::LinedTunnel& tunnel, double chainage_m, std::uint64_t seed) {
  return SurfaceCloud(downsample(
      tunnel.scan({{chainage_m, -2.0, 0.85}, Eigen::Quaterniond::Identity()}, {.step_deg = 1.0}, seed).points, 0.1,
      1.5));
}

AxialOverlap between(const SurfaceCloud& one, const SurfaceCloud& other) {
  return axial_overlap({.cloud = one}, {.cloud = other}, {}, Eigen::Vector3d::UnitX());
}

TEST(AxialOverlap, SamePlaceAgreesAndAnother5mOnDoesNot) {
  const test::LinedTunnel tunnel = test::LinedTunnel().furnish();
  const SurfaceCloud one = scan(tunnel, 35.0, 1);
  EXPECT_GT(between(one, scan(tunnel, 35.0, 2)).ratio(), 0.95);
  EXPECT_LT(between(one, scan(tunnel, 40.0, 2)).ratio(), 0.2);
}

TEST(AxialOverlap, WhatATruckHidesIsNotMissing) {
  test::LinedTunnel tunnel = test::LinedTunnel().furnish();
  const SurfaceCloud one = scan(tunnel, 35.0, 1);
  EXPECT_GT(between(one, scan(tunnel.park_truck(38.0, 1.5), 35.0, 2)).ratio(), 0.9);
}

TEST(AxialOverlap, BareTunnelHasNone) {
  const test::LinedTunnel bare;
  const AxialOverlap found = between(scan(bare, 50.0, 1), scan(bare, 50.0, 2));
  EXPECT_LT(found.num_common, 10);
}

}  // namespace
}  // namespace patrol::inspect::grip_test
