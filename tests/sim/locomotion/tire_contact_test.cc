#include "sim/locomotion/tire_contact.h"

#include <gtest/gtest.h>

#include "tests/support/simulated_quadruped.h"
#include "tests/support/simulated_wheeled_robot.h"
#include "tests/support/wheeled_urdf.h"

namespace patrol::sim::tire_contact_test {
namespace {

/// Robot of about 3 kg with driven wheels of 33 mm and a caster behind them.
test::UrdfRobot small_robot(double caster_radius_m) {
  return {.wheels = {{.name = "port", .x_m = 0.0, .y_m = 0.14, .radius_m = 0.033, .width_m = 0.02},
                     {.name = "starboard", .x_m = 0.0, .y_m = -0.14, .radius_m = 0.033, .width_m = 0.02},
                     {.name = "trailing",
                      .x_m = -0.17,
                      .y_m = 0.0,
                      .radius_m = caster_radius_m,
                      .width_m = caster_radius_m,
                      .is_driven = false,
                      .is_caster = true}},
          .mass_kg = 3.0,
          .center_of_mass_x_m = -0.05,
          .height_m = 0.06,
          .chassis_box = "0.3 0.25 0.05",
          .effort_nm = 1.0};
}

// The wheels of the shipped robots, 0.1651 m: 2 % are 3.3 mm, more than the least deflection of 0.63 mm.
TEST(TireContact, WheelsOf33MillimetersAndMoreKeepTheDeflectionOfTheSettings) {
  const WheeledRobot robot(make_flat_world(), small_robot(0.02).text());
  const mjModel& model = robot.model();
  const auto radius_of = [&model](const char* wheel) {
    return model.geom_size[3 * mj_name2id(&model, mjOBJ_GEOM, wheel)];
  };
  EXPECT_NEAR(radius_of("port"), 1.01 * 0.033, 1e-6);
  EXPECT_NEAR(radius_of("trailing"), 0.02 + 0.5 * 0.000628, 1e-6);
}

}  // namespace
}  // namespace patrol::sim::tire_contact_test
