#include "importer/mesh_text.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "importer/mesh.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::mesh_text_test {
namespace {

/// Returns the message of the check without the folder; "accepted" if there is none.
std::string error_of(const std::string& name, const std::string& text) {
  const test::TemporaryFile file(name, text);
  try {
    check_mesh_text(file.path());
  } catch (const InputError& error) {
    const std::string message = error.what();
    return message.substr(message.find(name));
  }
  return "accepted";
}

const std::string kObjTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(MeshText, InvalidNumbersAndIndicesOfAnObjAreRefusedWithTheirLine) {
  EXPECT_EQ(error_of("a.obj", "# x\nv 0 0 0\nv 1.0 x 2\n"), "a.obj:3: v: \"x\" is not a number");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\r\nv 1.0 nan 2\r\n"), "a.obj:2: v: nan: must be finite");
  EXPECT_EQ(error_of("a.obj", "v 0 0\n"), "a.obj:1: v: 2 values: must be at least 3");
  EXPECT_EQ(error_of("a.obj", kObjTriangle + "f 1 2 4\n"), "a.obj:4: f: 4: must be one of the 3 v");
  EXPECT_EQ(error_of("a.obj", kObjTriangle + "f 0 1 2\n"), "a.obj:4: f: 0: must be one of the 3 v");
  EXPECT_EQ(error_of("a.obj", kObjTriangle + "f -4 -2 -1\n"), "a.obj:4: f: -4: must be one of the 3 v");
  EXPECT_EQ(error_of("a.obj", kObjTriangle + "vt 0 0\nf 1/1 2/2 3/1\n"), "a.obj:5: f: 2/2: must be one of the 1 vt");
  EXPECT_EQ(error_of("a.obj", kObjTriangle + "f 1 2 x\n"), "a.obj:4: f: \"x\" is not an index");
  EXPECT_EQ(error_of("a.obj", "v 0 0 \\\n0\nv 0 x 0\n"), "a.obj:3: v: \"x\" is not a number");
}

TEST(MeshText, AllFormsOfNumbersAndFacesOfAnObjAreAccepted) {
  EXPECT_EQ(error_of("A.OBJ",
                     "v .6 -.5 +1.\nv 1e-400 1E+3 -1.5e-3 1.0\nv 0 1 0 0.5 0.5 0.5\nvn nan 0 1\n"
                     "f 1 2 3\nf 1//1 2//1 3//1 # c\nf 1/7 2/7 3/7\nf 1/7/1 2/7/1 \\\n3/7/1\nf -1 -2 -3\nl 1 2\n"),
            "accepted");
  EXPECT_EQ(error_of("a.obj", "f 1 2 3\r" + std::string("v 0 0 0\rv 1,5 0 0\rv 0 1 0\r")), "accepted");
}

const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

std::string replaced(std::string text, const std::string& old, const std::string& with) {
  return text.replace(text.find(old), old.size(), with);
}

TEST(MeshText, InvalidFacetsOfAnAsciiStlAreRefusedWithTheirLine) {
  const auto error = [](const std::string& facets) { return error_of("a.stl", "solid s\n" + facets + "endsolid s\n"); };
  EXPECT_EQ(error(kFacet + replaced(kFacet, "vertex 1", "vertx 1")),
            "a.stl:12: \"vertx\": must be outer loop, vertex, endloop or endfacet");
  EXPECT_EQ(error(replaced(kFacet, "1 0 0", "1.0 abc 2.0")), "a.stl:5: vertex: \"abc\" is not a number");
  EXPECT_EQ(error(replaced(kFacet, "1 0 0", "1 nan 0")), "a.stl:5: vertex: nan: must be finite");
  EXPECT_EQ(error(replaced(kFacet, "1 0 0", "1 0")), "a.stl:5: vertex: \"\" is not a number");
  EXPECT_EQ(error(replaced(kFacet, "vertex 1 0 0\n", "")), "a.stl:7: facet: 2 vertices: must be 3");
  EXPECT_EQ(error(replaced(kFacet, "endfacet\n", "")), "a.stl:8: endsolid: the facet before it has no endfacet");
  EXPECT_EQ(error_of("a.stl", "solid s\n" + kFacet.substr(0, 50)), "a.stl:5: vertex: \"\" is not a number");
  EXPECT_EQ(error(kFacet), "accepted");
  std::string on_one_line = kFacet;
  for (char& c : on_one_line) c = c == '\n' ? ' ' : c;
  EXPECT_EQ(error(on_one_line + "\nendsolid facet vertex\nsolid t\n" + replaced(kFacet, "0 0 1", "-nan(ind) 0 0")),
            "accepted");
}

TEST(MeshText, ABinaryStlThatIsCutIsRefusedWithItsSizes) {
  std::string bytes("solid of a binary file");
  bytes.resize(84 + 100, '\0');
  bytes[80] = 2;
  EXPECT_EQ(error_of("a.stl", bytes), "accepted");
  EXPECT_EQ(error_of("a.stl", bytes.substr(0, 150)),
            "a.stl: mesh cannot be read: a binary STL file of 2 triangles has 184 bytes, this one has 150");
}

std::string ply(const std::string& rows) {
  return "ply\nformat ascii 1.0\ncomment c\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "property uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         rows;
}

TEST(MeshText, RowsOfAnAsciiPlyWithAWrongNumberOfValuesAreRefusedWithTheirLine) {
  const std::string vertices = "0 0 0 255\n1 0 0 255\n0 1 0 255\n";
  EXPECT_EQ(error_of("a.ply", ply(vertices + "3 0 1 2\n")), "accepted");
  EXPECT_EQ(error_of("a.ply", ply("0 0 0 255\n1 2\n0 1 0 255\n3 0 1 2\n")),
            "a.ply:13: vertex: 2 values: too few for the properties up to z");
  EXPECT_EQ(error_of("a.ply", ply("0 0 0 255 7\n")), "a.ply:12: vertex: 5 values: the header has 4");
  EXPECT_EQ(error_of("a.ply", ply("0 x 0 255\n")), "a.ply:12: y: \"x\" is not a number");
  EXPECT_EQ(error_of("a.ply", ply("0 inf 0 255\n")), "a.ply:12: y: inf: must be finite");
  EXPECT_EQ(error_of("a.ply", ply(vertices + "3 0 1\n")),
            "a.ply:15: face: 3 values: too few for the properties up to vertex_indices");
  EXPECT_EQ(error_of("a.ply", ply(vertices + "3 0 1 3\n")),
            "a.ply:15: vertex_indices: 3: must be one of the 3 vertices, from 0");
  EXPECT_EQ(error_of("a.ply", ply(vertices + "-1\n")), "a.ply:15: vertex_indices: \"-1\" is not a number of values");
  EXPECT_EQ(error_of("a.ply", ply("0 0 0 255\n")), "a.ply:12: vertex: the file ends after 1 of 3 rows");
}

TEST(MeshText, MeshesOfRobotsAreCheckedAndMessagesOfTheLibraryAreShort) {
  const test::TemporaryFile file("a.obj", "v 0 0 0\nv 1 x 0\n");
  try {
    load_mesh(file.path());
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("a.obj:2: v: "));
  }
  EXPECT_LE(mesh_error(std::string(5000, 'x')).size(), 200U);
}

}  // namespace
}  // namespace patrol::importer::mesh_text_test
