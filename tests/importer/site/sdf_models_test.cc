#include <cstdlib>
#include <filesystem>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importer/mesh.h"
#include "tests/importer/site/mesh_files.h"
#include "tests/importer/site/sdf_text.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"
#include "tests/support/variable.h"

/// Models that worlds include, and versions of the format.
namespace patrol::importer::sdf_models_test {
namespace {

using sdf_text::collision, sdf_text::kBox, sdf_text::link, sdf_text::model, sdf_text::shape_of, sdf_text::visual,
    sdf_text::world;
using test::VectorNear;
using ::testing::HasSubstr;

TEST(SdfSite, IncludedModelsAreFoundBesideTheFileAndByOption) {
  const std::string include =
      world("<include><uri>model://crate</uri><name>c2</name><pose>3 0 0 0 0 0</pose></include>");
  for (const bool is_beside : {true, false}) {
    SiteFileImport import("a.sdf", include);
    const std::filesystem::path folder = import.folder / (is_beside ? "models/crate" : "elsewhere/box");
    std::filesystem::create_directories(folder / "meshes");
    test::write_bytes(folder / "model.config", "<model><name>crate</name><sdf version=\"1.6\">model.sdf</sdf></model>");
    Mesh box;
    add_box(box, {-0.5, -0.5, 0}, {0.5, 0.5, 1});
    test::write_bytes(folder / "meshes/box.obj", to_obj(box));
    const std::string mesh = "<mesh><uri>model://crate/meshes/box.obj</uri><scale>2 1 1</scale></mesh>";
    test::write_bytes(folder / "model.sdf",
                      "<sdf version=\"1.6\">" +
                          model("crate", visual(mesh) + collision("<mesh><uri>meshes/box.obj</uri></mesh>")) +
                          "</sdf>");
    if (!is_beside) import.options.packages["crate"] = folder;
    const sim::ModelPtr compiled = import.model();
    Eigen::AlignedBox3d extent;
    for (const SiteShape& shape : import.site.shapes) {
      if (shape.use != ShapeUse::kSeen) continue;
      for (const Eigen::Vector3d& v : shape.mesh.vertices_m) extent.extend(shape.T_site_shape * v);
    }
    EXPECT_THAT(extent.min(), VectorNear(Eigen::Vector3d(2, -0.5, 0), 1e-6));
    EXPECT_THAT(extent.max(), VectorNear(Eigen::Vector3d(4, 0.5, 1), 1e-6));
  }
}

TEST(SdfSite, ModelsAreFoundInBothVariablesOfGazeboAndTheOptionComesFirst) {
  SiteFileImport import("a.sdf", world("<include><uri>model://crate</uri></include>"));
  const auto write_crate = [&](const std::string& folder, const std::string& size_m) {
    std::filesystem::create_directories(import.folder / folder / "crate");
    test::write_bytes(import.folder / folder / "crate/model.config",
                      "<model><name>crate</name><sdf version=\"1.6\">model.sdf</sdf></model>");
    test::write_bytes(import.folder / folder / "crate/model.sdf",
                      "<sdf version=\"1.6\">" +
                          model("crate", visual("<sphere><radius>" + size_m + "</radius></sphere>")) + "</sdf>");
    return (import.folder / folder).string();
  };
  const auto radius_m = [&] {
    import.read();
    return import.site.shapes.front().size_m.x();
  };
  EXPECT_THAT(import.error(), HasSubstr("unknown model \"crate\""));
  for (const char* variable : {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH"}) {
    ::setenv(variable, ("/nowhere::" + write_crate("first", "0.5") + ":" + write_crate("second", "0.7")).c_str(), 1);
    EXPECT_EQ(radius_m(), 0.5) << variable;
    ::unsetenv(variable);
  }
  ::setenv("GAZEBO_MODEL_PATH", (import.folder / "first").c_str(), 1);
  import.options.packages["crate"] = write_crate("given", "0.9") + "/crate";
  EXPECT_EQ(radius_m(), 0.9);
  ::unsetenv("GAZEBO_MODEL_PATH");
}

/// Writes the model `name` beside the world, with its elements from line 2 on.
void write_model(const SiteFileImport& import, const std::string& name, const std::string& elements,
                 const std::string& version = "1.8") {
  const std::filesystem::path folder = import.folder / ("models/" + name);
  std::filesystem::create_directories(folder);
  test::write_bytes(folder / "model.config",
                    fmt::format("<model><name>{}</name><sdf version=\"{}\">model.sdf</sdf></model>", name, version));
  test::write_bytes(folder / "model.sdf",
                    fmt::format("<sdf version=\"{}\"><model name=\"{}\"><static>1</static>\n{}\n</model></sdf>",
                                version, name, elements));
}

std::string include(const std::string& name, const std::string& more = "") {
  return fmt::format("<include><uri>model://{}</uri>{}</include>", name, more);
}

TEST(SdfSite, ModelsThatIncludedModelsIncludeAreImportedWithTheirNamesAndPoses) {
  SiteFileImport import("a.sdf", world(include("hall", "<name>h</name><pose>10 0 0 0 0 1.5707963267948966</pose>")));
  write_model(import, "hall",
              "<frame name=\"f\"><pose>1 0 0 0 0 0</pose></frame>" + link(visual(kBox)) +
                  include("shelf", "<name>s1</name><pose relative_to=\"f\">2 0 0 0 0 0</pose>") +
                  include("shelf", "<name>s2</name><pose>0 0 5 0 0 0</pose>"));
  write_model(import, "shelf",
              link(visual(kBox)) + "<include>\n<uri>\n model://cup </uri><pose>0 1 0 0 0 0</pose></include>", "1.6");
  write_model(import, "cup", link(visual("<sphere><radius>0.1</radius></sphere>")));
  const ImportedSite& site = import.read();
  EXPECT_EQ(site.shapes.size(), 5u);
  EXPECT_THAT(shape_of(site, "h.s1.link.visual").T_site_shape.position, VectorNear(Eigen::Vector3d(10, 3, 0), 1e-6));
  EXPECT_THAT(shape_of(site, "h.s2.link.visual").T_site_shape.position, VectorNear(Eigen::Vector3d(10, 0, 5), 1e-6));
  EXPECT_THAT(shape_of(site, "h.s1.cup.link.visual").T_site_shape.position, VectorNear(Eigen::Vector3d(9, 3, 0), 1e-6));
}

TEST(SdfSite, AModelThatIncludesItselfAndOneThatIsNotFoundAreRefusedWithTheirFile) {
  SiteFileImport import("a.sdf", world(include("hall")));
  write_model(import, "hall", link("") + include("shelf"));
  write_model(import, "shelf", link("") + "\n" + include("hall"));
  EXPECT_EQ(import.error(), "models/shelf/model.sdf:3: <include>: \"model://hall\": the model includes itself");
  write_model(import, "shelf", link("") + "\n" + include("absent"));
  EXPECT_THAT(import.error(), ::testing::StartsWith("models/shelf/model.sdf:3: <include>: unknown model \"absent\": "));
  write_model(import, "shelf", link("") + "\n<include><uri/></include>");
  EXPECT_EQ(import.error(), "models/shelf/model.sdf:3: <uri>: is empty");
}

TEST(SdfSite, ErrorsOfIncludedModelsHaveTheirFileAndLine) {
  const std::string file = "models/crate/model.sdf:3: ";
  for (const bool is_nested : {false, true}) {
    SiteFileImport import("a.sdf", world(include(is_nested ? "hall" : "crate")));
    write_model(import, "hall", link("") + include("crate"));
    const auto error_of = [&](const std::string& elements) {
      write_model(import, "crate", elements);
      return import.error();
    };
    EXPECT_EQ(error_of("\n" + link(visual("<box><size>1 x 1</size></box>"))),
              file + "<size>: \"1 x 1\" is not a valid value");
    EXPECT_EQ(error_of("\n" + link(visual("<torus/>"))), file + "<torus>: is not a geometry of the format");
    EXPECT_EQ(error_of("\n<link>"), file + "not XML: mismatched element: a tag is not closed");
    EXPECT_EQ(error_of(link("") + "\n" + link("")), file + "link with name[link] already exists.");
    EXPECT_EQ(error_of(link("") + "\n<frame name='f' attached_to='g'/><frame name='g' attached_to='f'/>"),
              file + "<frame>: \"f\": attached_to: cycle of frames: must lead to a link, a model or the world");
  }
}

TEST(SdfSite, RowsOfIncludedModelsHaveTheirFileAndLine) {
  SiteFileImport import("a.sdf", world(include("crate")));
  write_model(import, "crate", link(visual(kBox)) + "\n<plugin name=\"p\" filename=\"p.so\"/>");
  import.read();
  EXPECT_EQ(import.assumption("<plugin>"), "ignored (crate/model.sdf:3)");
}

TEST(SdfSite, AWorldOfVersion111WithAModelOfVersion110AndARelativeMeshIsImported) {
  SiteFileImport import("a.sdf", world(include("crate", "<pose>3 0 0 0 0 0</pose>"), "1.11"));
  write_model(import, "crate",
              "<link name=\"link\"><inertial auto=\"true\"><density>500</density></inertial>" +
                  visual("<mesh optimization=\"convex_hull\"><uri>meshes/box.obj</uri></mesh>") + "</link>",
              "1.10");
  Mesh box;
  add_box(box, {-0.5, -0.5, 0}, {0.5, 0.5, 1});
  std::filesystem::create_directories(import.folder / "models/crate/meshes");
  test::write_bytes(import.folder / "models/crate/meshes/box.obj", to_obj(box));
  const SiteShape& shape = shape_of(import.read(), "crate.link.visual_1");
  EXPECT_EQ(shape.mesh.triangles.size(), 12u);
  EXPECT_THAT(shape.T_site_shape.position, VectorNear(Eigen::Vector3d(3, 0, 0), 1e-9));
  EXPECT_EQ(SiteFileImport("a.sdf", world(model("m", visual(kBox)), "1.13")).error(),
            "a.sdf:2: <sdf>: version = \"1.13\": must be 1.3 to 1.12");
}

TEST(SdfSite, ModelsThatAreNotFoundAreNamedTogether) {
  SiteFileImport import("a.sdf", world(include("one") +
                                       "\n<include><uri>\n https://fuel.gazebosim.org/1.0/O/models/Two%20B\n"
                                       "</uri></include>" +
                                       include("one")));
  EXPECT_EQ(
      import.error(),
      "a.sdf:3: <include>: 2 unknown models: \"one\", \"Two B\": download those of a network, and give the folder "
      "of each with --package NAME=FOLDER, or the folder above them in GAZEBO_MODEL_PATH or GZ_SIM_RESOURCE_PATH");
  const std::string same =
      SiteFileImport("a.sdf", world(include("one") + "\n<include><uri>model://one/</uri></include>")).error();
  EXPECT_THAT(same, ::testing::StartsWith("a.sdf:3: <include>: unknown model \"one\""));
}

TEST(SdfSite, ModelsOfGazeboClassicAreFoundBelowTheHomeFolder) {
  SiteFileImport import("a.sdf", world(include("crate")));
  write_model(import, "crate", link(visual(kBox)));
  std::filesystem::create_directories(import.folder / "home/.gazebo");
  std::filesystem::rename(import.folder / "models", import.folder / "home/.gazebo/models");
  const test::Variable home("HOME", (import.folder / "home").string());
  EXPECT_EQ(import.read().shapes.size(), 1u);
}

/// Writes a box of 1 m as OBJ.
void write_box(const std::filesystem::path& file) {
  Mesh box;
  add_box(box, {-0.5, -0.5, 0}, {0.5, 0.5, 1});
  std::filesystem::create_directories(file.parent_path());
  test::write_bytes(file, to_obj(box));
}

TEST(SdfSite, FilesAreFoundInTheFoldersAboveTheModelAndTheWorldAndByOption) {
  const auto mesh = [](const std::string& uri) { return link(visual("<mesh><uri>" + uri + "</uri></mesh>")); };
  SiteFileImport import("a.sdf", world(include("crate")));
  write_box(import.folder / "models/crate/meshes/box.obj");
  write_model(import, "crate", mesh("file://models/crate/meshes/box.obj"));
  EXPECT_EQ(import.read().shapes.size(), 1u);
  EXPECT_EQ(import.assumption("mesh box.obj"), "");
  // A path of another computer, of which only the end fits.
  write_model(import, "crate", mesh("file:///home/user/ws/meshes/box.obj"));
  EXPECT_EQ(import.read().shapes.size(), 1u);
  EXPECT_EQ(import.assumption("mesh box.obj"),
            "not found where the file names it: models/crate/meshes/box.obj is used");
  // The folder of a package that the path names.
  write_box(import.folder / "elsewhere/parts/lid.obj");
  write_model(import, "crate", mesh("file://models/lids/parts/lid.obj"));
  EXPECT_THAT(import.error(), HasSubstr("model.sdf:2: <mesh>: file://models/lids/parts/lid.obj: file not found"));
  import.options.packages["lids"] = import.folder / "elsewhere";
  EXPECT_EQ(import.read().shapes.size(), 1u);
  import.options.packages.clear();
  const test::Variable variable("GAZEBO_RESOURCE_PATH", (import.folder / "elsewhere").string());
  EXPECT_EQ(import.read().shapes.size(), 1u);
}

}  // namespace
}  // namespace patrol::importer::sdf_models_test
