#include "sim/height_field_contact.h"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "sim/mujoco.h"

namespace patrol::sim::height_field_contact_test {
namespace {

/// Height field of 1 m cells, 4 m x 4 m about the origin; heights in meters, row by row from y = -2 m.
ModelPtr make_field(const std::string& heights_m) {
  return compile(*parse_spec(fmt::format(R"(<mujoco><asset><hfield name="field" nrow="5" ncol="5" size="2 2 1 0.5"
      elevation="{}"/></asset><worldbody><geom name="field" type="hfield" hfield="field"/><body pos="0 0 9">
      <freejoint/><geom name="ball" size="0.3"/></body></worldbody></mujoco>)",
                                         heights_m)),
                 "field");
}

std::string profile_along_x(const std::string& row) { return fmt::format("{0} {0} {0} {0} {0}", row); }

std::vector<SphereContact> contacts(const mjModel& model, const Eigen::Vector3d& center) {
  return contacts_with_height_field(model, 0, center, 0.3, 0.0);
}

// MuJoCo scales elevations to 0 ... 1: every profile contains both.
TEST(HeightFieldContact, EvenGroundGivesOneContactAlsoAboveAnEdgeAndACorner) {
  const ModelPtr plateau = make_field(profile_along_x("0 1 1 1 0"));
  for (const double x : {-0.5, -0.3, 0.0, 0.4}) {
    for (const double y : {-0.5, -0.3, 0.0, 0.4}) {
      const auto found = contacts(*plateau, {x, y, 1.28});
      ASSERT_EQ(found.size(), 1u) << x << ", " << y;
      EXPECT_NEAR(found[0].distance_m, -0.02, 1e-12);
      EXPECT_LT((found[0].point - Eigen::Vector3d(x, y, 1.0)).norm(), 1e-12);
      EXPECT_LT((found[0].normal - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
    }
  }
}

TEST(HeightFieldContact, ASlopeOf45DegreesPushesAlongItsNormal) {
  const ModelPtr slope = make_field(profile_along_x("0 1 1 1 0"));
  const Eigen::Vector3d normal(-std::sqrt(0.5), 0.0, std::sqrt(0.5)), on_slope(-1.6, 0.3, 0.4);
  const auto found = contacts(*slope, on_slope + 0.25 * normal);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].distance_m, -0.05, 1e-12);
  EXPECT_LT((found[0].normal - normal).norm(), 1e-12);
  EXPECT_LT((found[0].point - on_slope).norm(), 1e-12);
}

TEST(HeightFieldContact, AFurrowGivesTwoContactsAndARidgeOne) {
  const ModelPtr furrow = make_field(profile_along_x("1 1 0 1 1")), ridge = make_field(profile_along_x("0 0 1 0 0"));
  const auto in_furrow = contacts(*furrow, {0.0, 0.2, 0.29 * std::sqrt(2.0)});
  ASSERT_EQ(in_furrow.size(), 2u);
  for (const SphereContact& contact : in_furrow) {
    EXPECT_NEAR(contact.distance_m, -0.01, 1e-12);
    EXPECT_NEAR(std::abs(contact.normal.x()), std::sqrt(0.5), 1e-12);
  }
  EXPECT_NEAR(in_furrow[0].normal.x(), -in_furrow[1].normal.x(), 1e-12);
  const auto on_ridge = contacts(*ridge, {0.0, 0.2, 1.28});
  ASSERT_EQ(on_ridge.size(), 1u);
  EXPECT_NEAR(on_ridge[0].distance_m, -0.02, 1e-12);
  EXPECT_LT((on_ridge[0].point - Eigen::Vector3d(0.0, 0.2, 1.0)).norm(), 1e-12);
}

TEST(HeightFieldContact, ACenterBelowTheSurfaceIsPushedOutUpward) {
  const ModelPtr plateau = make_field(profile_along_x("0 1 1 1 0"));
  const auto found = contacts(*plateau, {0.3, -0.2, 0.9});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].distance_m, -0.4, 1e-12);
  EXPECT_LT((found[0].normal - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(HeightFieldContact, BesideAndAboveTheFieldThereIsNone) {
  const ModelPtr plateau = make_field(profile_along_x("1 1 0 1 1"));
  EXPECT_TRUE(contacts(*plateau, {2.31, 0.0, 1.0}).empty());
  EXPECT_FALSE(contacts(*plateau, {2.1, 0.0, 1.1}).empty()) << "over the border";
  EXPECT_TRUE(contacts(*plateau, {1.5, 0.0, 1.301}).empty());
}

/// The depth of the deepest contact is the radius less the distance to the surface, found by a dense sampling of it.
TEST(HeightFieldContact, OnRoughGroundTheDeepestContactIsTheNearestPointWithin1MillimeterIn300Draws) {
  const RandomStream random(3, "field");
  std::string heights;
  for (std::uint64_t i = 0; i < 25; ++i)
    heights += fmt::format("{:.3f} ", i == 0 ? 0.0 : i == 1 ? 1.0 : random.uniform(i, 0));
  const ModelPtr rough = make_field(heights);
  const DataPtr data = make_data(*rough);
  mj_kinematics(rough.get(), data.get());
  constexpr mjtByte kAll[mjNGROUP] = {1, 1, 1, 1, 1, 1};
  const mjtNum down[3] = {0, 0, -1};
  int touching = 0;
  for (std::uint64_t draw = 0; draw < 300; ++draw) {
    const double x = 2.4 * random.uniform(draw, 1) - 1.2, y = 2.4 * random.uniform(draw, 2) - 1.2;
    const auto height_m = [&](double at_x, double at_y) {
      const mjtNum from[3] = {at_x, at_y, 5.0};
      return 5.0 - mj_ray(rough.get(), data.get(), from, down, kAll, 1, 1, nullptr, nullptr);
    };
    const Eigen::Vector3d center(x, y, height_m(x, y) + 0.05 + 0.4 * random.uniform(draw, 3));
    double nearest_m = 1.0;
    for (int i = -60; i <= 60; ++i) {
      for (int j = -60; j <= 60; ++j) {
        const Eigen::Vector3d p(x + 0.005 * i, y + 0.005 * j, height_m(x + 0.005 * i, y + 0.005 * j));
        nearest_m = std::min(nearest_m, (p - center).norm());
      }
    }
    double deepest_m = 0.0;
    for (const SphereContact& contact : contacts(*rough, center)) {
      deepest_m = std::min(deepest_m, contact.distance_m);
      EXPECT_NEAR((center - contact.point).norm(), 0.3 + contact.distance_m, 1e-12);
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);
    }
    if (deepest_m < 0.0) ++touching;
    EXPECT_NEAR(deepest_m, std::min(0.0, nearest_m - 0.3), 1e-3) << center.transpose();
  }
  EXPECT_GT(touching, 60);
  EXPECT_LT(touching, 240);
}

TEST(HeightFieldContact, ABallRestsAtTheHeightOfItsRadiusAndOnASlopeRollsAsInClosedForm) {
  constexpr double kPlateau_m = 1.0;
  const ModelPtr plateau = make_field(profile_along_x("0 1 1 1 0"));
  const DataPtr data = make_data(*plateau);
  data->qpos[2] = kPlateau_m + 0.35;
  while (data->time < 2.0) mj_step(plateau.get(), data.get());
  EXPECT_EQ(data->ncon, 1);
  EXPECT_NEAR(data->qpos[2], kPlateau_m + 0.3, 1e-3);
  // Slope of 45 degrees with enough friction: acceleration 5/7 g sin(45 degrees).
  const DataPtr rolling = make_data(*plateau);
  plateau->geom_friction[0] = plateau->geom_friction[3] = 2.0;
  rolling->qpos[0] = 1.1 + 0.3 * std::sqrt(0.5);
  rolling->qpos[2] = 0.9 + 0.3 * std::sqrt(0.5);
  const double from_x_m = rolling->qpos[0];
  while (rolling->time < 0.4) mj_step(plateau.get(), rolling.get());
  const double expected_m = 0.5 * (5.0 / 7.0) * 9.81 * std::sqrt(0.5) * 0.4 * 0.4;
  EXPECT_NEAR((rolling->qpos[0] - from_x_m) * std::sqrt(2.0), expected_m, 0.05 * expected_m);
}

}  // namespace
}  // namespace patrol::sim::height_field_contact_test
