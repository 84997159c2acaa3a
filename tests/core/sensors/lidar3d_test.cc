#include "core/sensors/lidar3d.h"

#include <gtest/gtest.h>

namespace patrol::lidar3d_test {
namespace {

TEST(PointCloud, AnOffsetOfTheReadingMovesPointsAlongTheirRays) {
  PointCloud cloud;
  cloud.points = {{.x = 3.0F, .y = -4.0F, .z = 0.0F, .intensity = 1.0F, .time_s = 0.0F, .ring = 0},
                  {.x = 0.0F, .y = 0.0F, .z = 0.5F, .intensity = 1.0F, .time_s = 0.0F, .ring = 0}};
  SensorTraits<PointCloud>::add_to_reading(cloud, -1.0);
  EXPECT_FLOAT_EQ(cloud.points[0].x, 2.4F);
  EXPECT_FLOAT_EQ(cloud.points[0].y, -3.2F);
  EXPECT_FLOAT_EQ(cloud.points[1].z, 0.0F) << "not behind the sensor";
}

}  // namespace
}  // namespace patrol::lidar3d_test
