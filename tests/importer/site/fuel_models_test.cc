#include "importer/site/fuel_models.h"

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importer/mesh.h"
#include "tests/importer/site/mesh_files.h"
#include "tests/importer/site/sdf_text.h"
#include "tests/support/temporary_file.h"
#include "tests/support/variable.h"

namespace patrol::importer::fuel_models_test {
namespace {

using sdf_text::visual, sdf_text::world;
using ::testing::HasSubstr;

TEST(FuelModels, UrisNameOwnerModelVersionAndFile) {
  const auto model =
      fuel_model("https://fuel.gazebosim.org/1.0/OpenRobotics/models/Jersey%20Barrier/3/files/meshes/a.dae");
  ASSERT_TRUE(model);
  EXPECT_EQ(model->host, "fuel.gazebosim.org");
  EXPECT_EQ(model->owner, "OpenRobotics");
  EXPECT_EQ(model->name, "Jersey Barrier");
  EXPECT_EQ(model->version, "3");
  EXPECT_EQ(model->file, "meshes/a.dae");
  const auto page = fuel_model("https://app.gazebosim.org/OpenRobotics/fuel/models/Warehouse");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->owner, "OpenRobotics");
  EXPECT_EQ(fuel_model("https://fuel.gazebosim.org/1.0/O/models/A/tip")->version, "");
  EXPECT_EQ(fuel_model("http://models.gazebosim.org/sun/")->name, "sun");
  EXPECT_FALSE(fuel_model("https://host"));
  EXPECT_FALSE(fuel_model("model://sun"));
}

/// Writes a model with a ball, and a mesh that its URI names, into a folder.
void write_ball(const std::filesystem::path& folder, double radius_m, const std::string& more = "") {
  std::filesystem::create_directories(folder / "meshes");
  test::write_bytes(folder / "model.config", "<model><name>Ball</name><sdf version=\"1.6\">model.sdf</sdf></model>");
  test::write_bytes(
      folder / "model.sdf",
      fmt::format("<sdf version=\"1.6\"><model name=\"ball\"><link name=\"link\">{}{}</link></model></sdf>",
                  visual(fmt::format("<sphere><radius>{}</radius></sphere>", radius_m)), more));
}

std::string include(const std::string& uri) { return world("<include><uri>" + uri + "</uri></include>"); }

TEST(FuelModels, ModelsAreFoundInTheCacheByVersionAndByOptionWithoutCase) {
  SiteFileImport import("a.sdf", include("\n https://fuel.ignitionrobotics.org/1.0/OpenRobotics/models/Blue Ball\n"));
  const auto radius_m = [&] { return import.read().shapes.front().size_m.x(); };
  const test::Variable home("HOME", (import.folder / "home").string());
  EXPECT_THAT(import.error(), HasSubstr("a.sdf:3: <include>: model \"Blue Ball\" is not in the cache ~/.gz/fuel: "));
  const std::filesystem::path cached = import.folder / "home/.gz/fuel/fuel.gazebosim.org/openrobotics/models/blue ball";
  write_ball(cached / "9", 0.9);
  write_ball(cached / "10", 1.0);
  EXPECT_EQ(radius_m(), 1.0);
  import.options.packages["blue ball"] = cached / "9";
  EXPECT_EQ(radius_m(), 0.9);
  import.options.packages["blue ball"] = cached;
  EXPECT_EQ(radius_m(), 1.0);
  SiteFileImport versioned("a.sdf", include("https://fuel.gazebosim.org/1.0/openrobotics/models/Blue Ball/9"));
  EXPECT_EQ(versioned.read().shapes.front().size_m.x(), 0.9);
}

TEST(FuelModels, TheGroundPlaneAndTheSunOfGazeboAreKnownAndOthersOfTheNameAreNot) {
  const std::string fuel = "https://fuel.gazebosim.org/1.0/";
  SiteFileImport import("a.sdf", world("<include><uri>" + fuel +
                                       "OpenRobotics/models/Ground Plane</uri></include><include><uri>" + fuel +
                                       "openrobotics/models/Sun</uri></include>"));
  const test::Variable home("HOME", (import.folder / "home").string());
  EXPECT_EQ(import.read().shapes.front().type, SiteShapeType::kPlane);
  EXPECT_THAT(import.assumption(fuel + "OpenRobotics/models/Ground Plane"), HasSubstr("the plane z = 0"));
  SiteFileImport other("a.sdf", include(fuel + "somebody/models/Ground Plane"));
  EXPECT_THAT(other.error(), HasSubstr("model \"Ground Plane\" is not in the cache"));
}

TEST(FuelModels, AMeshOfANetworkIsFoundInTheFolderOfItsModel) {
  const std::string uri = "https://fuel.gazebosim.org/1.0/o/models/Ball";
  SiteFileImport import("a.sdf", include(uri));
  import.options.packages["Ball"] = import.folder / "ball";
  write_ball(import.folder / "ball", 0.5,
             "<visual name=\"box\"><geometry><mesh><uri>" + uri +
                 "/2/files/meshes/box.obj</uri></mesh></geometry></visual>");
  Mesh box;
  add_box(box, {-0.5, -0.5, 0}, {0.5, 0.5, 1});
  test::write_bytes(import.folder / "ball/meshes/box.obj", to_obj(box));
  EXPECT_EQ(import.read().shapes.size(), 2u);
  EXPECT_EQ(import.assumption("mesh box.obj"), "");
}

}  // namespace
}  // namespace patrol::importer::fuel_models_test
