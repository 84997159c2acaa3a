#include "inspect/lining/grip.h"

#include <gtest/gtest.h>

#include "tests/support/lined_tunnel.h"

namespace patrol::inspect::grip_test {
namespace {

SurfaceCloud scan(const test::LinedTunnel& tunnel, double chainage_m, std::uint64_t seed) {
  return SurfaceCloud(thin(tunnel.scan({{chainage_m, -2.0, 0.85}, Eigen::Quaterniond::Identity()}, {.step_deg = 1.0}, seed).points, 0.1, 1.5));
}

Grip between(const SurfaceCloud& one, const SurfaceCloud& other) { return grip({.cloud = one}, {.cloud = other}, {}, Eigen::Vector3d::UnitX()); }

TEST(Grip, SamePlaceAgreesAndAnother5mOnDoesNot) {
  const test::LinedTunnel tunnel = test::LinedTunnel().furnish();
  const SurfaceCloud one = scan(tunnel, 35.0, 1);
  EXPECT_GT(between(one, scan(tunnel, 35.0, 2)).share(), 0.95);
  EXPECT_LT(between(one, scan(tunnel, 40.0, 2)).share(), 0.2);
}

TEST(Grip, WhatATruckHidesIsNotMissing) {
  test::LinedTunnel tunnel = test::LinedTunnel().furnish();
  const SurfaceCloud one = scan(tunnel, 35.0, 1);
  EXPECT_GT(between(one, scan(tunnel.park_truck(38.0, 1.5), 35.0, 2)).share(), 0.9);
}

TEST(Grip, BareTunnelHasNone) {
  const test::LinedTunnel bare;
  const Grip found = between(scan(bare, 50.0, 1), scan(bare, 50.0, 2));
  EXPECT_LT(found.same, 10);
}

}  // namespace
}  // namespace patrol::inspect::grip_test
