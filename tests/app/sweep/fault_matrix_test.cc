#include "app/sweep/fault_matrix.h"

#include <gtest/gtest.h>

namespace patrol::app::fault_matrix_test {
namespace {

TEST(FaultMatrix, AFaultBecomesTheSettingThatDeclaresIt) {
  EXPECT_EQ(fault_override({.sensor = "imu", .kind = "drift", .start_s = 12.0, .duration_s = 8.0, .magnitude = 0.005}),
            "faults=[{sensor: imu, kind: drift, start_s: 12, duration_s: 8, magnitude: 0.005}]");
}

TEST(FaultMatrix, AVariantsNameIsReadBackAsSensorAndKind) {
  const FaultVariant fault = fault_of(variant_name({.sensor = "joint_encoders", .kind = "clock_offset", .start_s = 12.0, .duration_s = 8.0, .magnitude = 0.2}));
  EXPECT_EQ(fault.sensor, "joint_encoders");
  EXPECT_EQ(fault.kind, "clock_offset");
  EXPECT_EQ(fault_of("no fault").kind, "");
}

}  // namespace
}  // namespace patrol::app::fault_matrix_test
