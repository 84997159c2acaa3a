#include "importer/site/enclosing_solid.h"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/mujoco.h"

namespace patrol::importer::enclosing_solid_test {
namespace {

struct Site {
  explicit Site(const std::string& geom, const std::string& assets = "")
      : model(sim::compile(*sim::parse_spec(fmt::format(
                               "<mujoco>{}<worldbody><geom name=\"it\" {}/></worldbody></mujoco>", assets, geom)),
                           "site")),
        data(sim::make_data(*model)) {
    mj_kinematics(model.get(), data.get());
  }

  bool contains(double x, double y, double z) const { return enclosing_solid(*model, *data, {x, y, z}) == "it"; }

  sim::ModelPtr model;
  sim::DataPtr data;
};

TEST(EnclosingSolid, EachShapeContainsWhatItsFormulaSays) {
  const Site box(R"(type="box" size="1 2 3" pos="10 0 0" euler="0 0 90")");
  EXPECT_TRUE(box.contains(11.9, 0.9, -2.9));
  EXPECT_FALSE(box.contains(10.9, 1.1, 0.0));
  const Site sphere(R"(type="sphere" size="2" pos="0 0 1")");
  EXPECT_TRUE(sphere.contains(1.1, 1.1, 2.1));
  EXPECT_FALSE(sphere.contains(1.2, 1.2, 2.2));
  const Site ellipsoid(R"(type="ellipsoid" size="1 2 3")");
  EXPECT_TRUE(ellipsoid.contains(0.0, 1.9, 0.0));
  EXPECT_FALSE(ellipsoid.contains(0.8, 1.6, 0.0));
  const Site cylinder(R"(type="cylinder" size="1 2")");
  EXPECT_TRUE(cylinder.contains(0.7, 0.7, 1.9));
  EXPECT_FALSE(cylinder.contains(0.0, 0.0, 2.1));
  EXPECT_FALSE(cylinder.contains(0.8, 0.8, 0.0));
  const Site capsule(R"(type="capsule" size="1 2")");
  EXPECT_TRUE(capsule.contains(0.0, 0.0, 2.9));
  EXPECT_FALSE(capsule.contains(0.8, 0.0, 2.8));
}

TEST(EnclosingSolid, AMeshContainsItsConvexHull) {
  const Site wedge(R"(type="mesh" mesh="wedge" pos="5 0 0")",
                   R"(<asset><mesh name="wedge" vertex="0 0 0  2 0 0  0 2 0  0 0 2"/></asset>)");
  EXPECT_TRUE(wedge.contains(5.6, 0.6, 0.6));
  EXPECT_FALSE(wedge.contains(5.7, 0.7, 0.7));
  EXPECT_FALSE(wedge.contains(4.9, 0.5, 0.5));
}

TEST(EnclosingSolid, GroundAndGeomsWithoutContactContainNothing) {
  EXPECT_FALSE(Site(R"(type="plane" size="1 1 1")").contains(0.0, 0.0, -1.0));
  EXPECT_FALSE(Site(R"(type="box" size="1 1 1" contype="0" conaffinity="0")").contains(0.0, 0.0, 0.0));
}

}  // namespace
}  // namespace patrol::importer::enclosing_solid_test
