#include "app/check/check_world.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "sim/mujoco.h"

namespace patrol::app::check_world_test {
namespace {

/// Surface heights of a world on the x axis.
class Surface {
 public:
  explicit Surface(const CheckWorld& world)
      : model_(sim::compile(*sim::parse_spec(world.mjcf), "check")), data_(sim::make_data(*model_)) {
    mj_forward(model_.get(), data_.get());
  }

  double height_m(double x_m) const {
    constexpr double kAbove_m = 10.0;
    const mjtNum from[3] = {x_m, 0.3, kAbove_m}, down[3] = {0.0, 0.0, -1.0};
    return kAbove_m - mj_ray(model_.get(), data_.get(), from, down, nullptr, true, -1, nullptr, nullptr);
  }
  const mjModel& model() const { return *model_; }

 private:
  sim::ModelPtr model_;
  sim::DataPtr data_;
};

TEST(CheckWorld, TheRampRisesByItsAngleToALevelTopAndFallsBackToTheGround) {
  const CheckWorld world = ramp_world(1.5);
  const Surface surface(world);
  const double slope = std::tan(to_rad(kRampAngle_deg)), run_m = kRampLength_m * std::cos(to_rad(kRampAngle_deg));
  EXPECT_NEAR(surface.height_m(1.4), 0.0, 1e-9);
  for (const double along_m : {0.1, 1.0, 2.8}) {
    EXPECT_NEAR(surface.height_m(1.5 + along_m), along_m * slope, 1e-6) << along_m;
    EXPECT_NEAR(surface.height_m(world.end_x_m - along_m), along_m * slope, 1e-6) << along_m;
  }
  EXPECT_NEAR(surface.height_m(1.5 + run_m + 0.5 * kRampTop_m), run_m * slope, 1e-6);
  EXPECT_NEAR(surface.height_m(world.end_x_m + 0.1), 0.0, 1e-9);
}

TEST(CheckWorld, TheStepsAre3CentimetersHighAndHalfAMeterApartUpAndDown) {
  const CheckWorld world = steps_world(2.0);
  const Surface surface(world);
  EXPECT_NEAR(surface.height_m(1.99), 0.0, 1e-9);
  for (int step = 0; step < kNumSteps; ++step) {
    const double middle_m = (step + 0.5) * kStepSpacing_m;
    EXPECT_NEAR(surface.height_m(2.0 + middle_m), (step + 1) * 0.03, 1e-9) << step;
    EXPECT_NEAR(surface.height_m(world.end_x_m - middle_m), (step + 1) * 0.03, 1e-9) << step;
  }
  EXPECT_NEAR(surface.height_m(world.end_x_m + 0.01), 0.0, 1e-9);
}

TEST(CheckWorld, TheSlopeRisesByItsAngle) {
  const Surface surface(slope_world(2.0));
  EXPECT_NEAR(surface.height_m(1.9), 0.0, 1e-9);
  EXPECT_NEAR(surface.height_m(7.0), 5.0 * std::tan(to_rad(kRampAngle_deg)), 1e-6);
}

TEST(CheckWorld, EverySurfaceIsGround) {
  for (const CheckWorld& world : {plane_world(), ramp_world(1.0), steps_world(1.0), slope_world(1.0)}) {
    const Surface surface(world);
    for (int geom = 0; geom < surface.model().ngeom; ++geom)
      EXPECT_TRUE(sim::name_of(surface.model(), mjOBJ_GEOM, geom).starts_with("ground")) << geom;
  }
}

}  // namespace
}  // namespace patrol::app::check_world_test
