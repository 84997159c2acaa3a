#include "render/gas_puffs.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/error.h"
#include "render/scene/palette.h"
#include "tests/render/small_scene.h"

namespace patrol::render::gas_puffs_test {
namespace {

constexpr int kWidth = 320, kHeight = 180;
const sim::WindSettings kWestWind{.speed_mps = 1.0, .direction_deg = 270.0, .stability = "D"};  // blows to +x

GasCloud leak_at_origin(double start_s = 0.0) {
  const sim::ModelPtr model = small_scene(R"(<site name="valve" pos="0 0 0.5"/>)");
  return GasCloud(*model, {{.at = "valve", .rate_g_s = 1.0, .start_s = start_s}}, kWestWind);
}

TEST(GasCloud, LiesDownwindAndIsAsDenseAsThePlume) {
  const std::vector<Puff> puffs = leak_at_origin().puffs(10.0, 0.0);
  ASSERT_GT(puffs.size(), 50u);
  double upwind = 0.0, downwind = 0.0;
  for (const Puff& puff : puffs) (puff.p_world_m.x() < -0.3 ? upwind : downwind) += puff.column_ppm_m;
  EXPECT_LT(upwind, 0.01 * downwind);
}

// What the simulated meter would read along a line across the plume, 1.5 m downwind: the puffs along that line add up
// to it.
TEST(GasCloud, ItsPuffsAddUpToTheSimulatedColumn) {
  const sim::GasPlume plume(Eigen::Vector3d(0.0, 0.0, 0.5), 1.0, kWestWind);
  const double column_ppm_m = plume.column_ppm_m({1.5, -4.0, 0.5}, Eigen::Vector3d::UnitY(), 8.0, 10.0);
  double mean_ppm_m = 0.0;  // over the drift: the lattice's points pass by
  constexpr int kDrifts = 50;
  for (int i = 0; i < kDrifts; ++i) {
    for (const Puff& puff : leak_at_origin().puffs(10.0, 0.01 * i)) {
      const double off_line_m = (puff.p_world_m - Eigen::Vector3d(1.5, puff.p_world_m.y(), 0.5)).norm();
      mean_ppm_m +=
          puff.column_ppm_m * std::exp(-0.5 * off_line_m * off_line_m / (puff.radius_m * puff.radius_m)) / kDrifts;
    }
  }
  EXPECT_NEAR(mean_ppm_m / column_ppm_m, 1.0, 0.25);  // a few puffs for a smooth plume
}

TEST(GasCloud, IsNotThereBeforeTheLeakBegins) {
  EXPECT_TRUE(leak_at_origin(20.0).puffs(19.0, 0.0).empty());
  EXPECT_FALSE(leak_at_origin(20.0).puffs(21.0, 0.0).empty());
}

TEST(GasCloud, RefusesALeakOfNoSite) {
  const sim::ModelPtr model = small_scene("");
  EXPECT_THROW(GasCloud(*model, {{.at = "nowhere"}}, kWestWind), InputError);
}

class DrawPuffs : public ::testing::Test {
 protected:
  /// A grey frame with the gas 5 m ahead of the eye, before or behind what stands at `wall_m`.
  Frame draw(float wall_share_of_depth) {
    Frame frame(kWidth, kHeight, {100, 100, 100});
    const std::vector<float> depth(static_cast<std::size_t>(kWidth * kHeight), wall_share_of_depth);
    draw_puffs(frame, depth, Projector(view, kWidth, kHeight), {{{5.0, 0.0, 1.0}, 0.3, 4000.0}});
    return frame;
  }
  const View view = look_at({0.0, 0.0, 1.0}, {5.0, 0.0, 1.0});
};

TEST_F(DrawPuffs, TintsWhatIsBehindThem) {
  const Frame frame = draw(1.0f);
  const Color middle = frame.at(kWidth / 2, kHeight / 2), corner = frame.at(3, 3);
  EXPECT_NEAR(middle.g, 100 + (kGasColor.g - 100) * (1.0 - std::exp(-1.0)), 4);
  EXPECT_EQ(corner, (Color{100, 100, 100}));
}

TEST_F(DrawPuffs, AreHiddenByWhatStandsBeforeThem) { EXPECT_EQ(draw(0.5f), Frame(kWidth, kHeight, {100, 100, 100})); }

}  // namespace
}  // namespace patrol::render::gas_puffs_test
