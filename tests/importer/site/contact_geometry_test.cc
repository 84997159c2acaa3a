#include "importer/site/contact_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/importer/site/mesh_files.h"

namespace patrol::importer::contact_geometry_test {
namespace {

using ::testing::HasSubstr;

int count(const ContactGeometry& contact, SiteShapeType type) {
  return static_cast<int>(std::count_if(contact.shapes.begin(), contact.shapes.end(),
                                        [&](const SiteShape& shape) { return shape.type == type; }));
}

const SiteShape& ground_of(const ContactGeometry& contact) {
  for (const SiteShape& shape : contact.shapes) {
    if (shape.name == "contact_ground") return shape;
  }
  throw std::runtime_error("no ground");
}

/// Returns whether a sphere touches the contact geometry.
class SphereProbe {
 public:
  SphereProbe(const ContactGeometry& contact, double radius_m) {
    const test::TemporaryFolder folder;
    ImportedSite site{.name = "site", .source = "test", .materials = {contact_material()}, .shapes = contact.shapes};
    write_site(site, folder / "site");
    std::string xml = test::read_bytes(folder / "site/site.xml");
    const std::string probe = fmt::format(
        R"(<body name="probe"><freejoint/><geom type="sphere" size="{}" contype="2" conaffinity="1"/></body>)",
        radius_m);
    xml.insert(xml.find("</worldbody>"), probe);
    test::write_bytes(folder / "site/probe.xml", xml);
    model_ = sim::compile(*sim::load_spec((folder / "site/probe.xml").string()), "probe");
    data_ = sim::make_data(*model_);
  }

  bool touches(const Eigen::Vector3d& center) {
    std::copy_n(center.data(), 3, data_->qpos);
    mj_forward(model_.get(), data_.get());
    for (int i = 0; i < data_->ncon; ++i) {
      if (data_->contact[i].dist < 0.0) return true;
    }
    return false;
  }

 private:
  sim::ModelPtr model_;
  sim::DataPtr data_;
};

/// Floor of 8 x 6 m with walls of 2.8 m, welded, with a door of 1 m in a diagonal inner wall, and a roof at 2.8 m.
Mesh two_rooms() {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, {8, 6, 2.8}, true);
  add_quad(mesh, {3, 0, 0}, {4.2, 2.5, 0}, {4.2, 2.5, 2.8}, {3, 0, 2.8});
  add_quad(mesh, {4.2, 2.5, 2.1}, {4.7, 3.5, 2.1}, {4.7, 3.5, 2.8}, {4.2, 2.5, 2.8});
  add_quad(mesh, {4.7, 3.5, 0}, {5.9, 6, 0}, {5.9, 6, 2.8}, {4.7, 3.5, 2.8});
  return mesh;
}

/// Random points on the triangles, and distances from them.
class SurfacePoints {
 public:
  explicit SurfacePoints(const Mesh& mesh) : mesh_(mesh) {}

  Eigen::Vector3d draw() {
    std::uniform_int_distribution<std::size_t> pick(0, mesh_.triangles.size() - 1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto& t = mesh_.triangles[pick(random_)];
    double u = unit(random_), v = unit(random_);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    return corner(t, 0) + u * (corner(t, 1) - corner(t, 0)) + v * (corner(t, 2) - corner(t, 0));
  }

  Eigen::Vector3d draw_in(const Eigen::AlignedBox3d& box) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    return box.min() + box.sizes().cwiseProduct(Eigen::Vector3d(unit(random_), unit(random_), unit(random_)));
  }

  /// Distance from the nearest triangle [Ericson05, section 5.1.5].
  double distance(const Eigen::Vector3d& p) const {
    double least = 1e9;
    for (const auto& t : mesh_.triangles) least = std::min(least, (p - nearest(p, t)).norm());
    return least;
  }

 private:
  const Eigen::Vector3d& corner(const std::array<int, 3>& t, std::size_t k) const {
    return mesh_.vertices_m[static_cast<std::size_t>(t[k])];
  }

  /// Nearest point: that of the plane if it is inside of the triangle, else that of an edge.
  Eigen::Vector3d nearest(const Eigen::Vector3d& p, const std::array<int, 3>& t) const {
    const Eigen::Vector3d &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    const Eigen::Vector3d n = (b - a).cross(c - a).normalized();
    const Eigen::Vector3d q = p - n.dot(p - a) * n;
    const bool is_inside =
        n.dot((b - a).cross(q - a)) >= 0 && n.dot((c - b).cross(q - b)) >= 0 && n.dot((a - c).cross(q - c)) >= 0;
    if (is_inside) return q;
    Eigen::Vector3d best = a;
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      const double s = std::clamp((p - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
      const Eigen::Vector3d on = from + s * (to - from);
      if ((p - on).norm() < (p - best).norm()) best = on;
    }
    return best;
  }

  const Mesh& mesh_;
  std::mt19937 random_{2001};
};

/// Slab from -0.3 to 0 m, with a table on it.
Mesh thick_slab() {
  Mesh mesh;
  add_box(mesh, {-5, -4, -0.3}, {5, 4, 0});
  add_box(mesh, {1, 1, 0}, {2, 2, 0.8});
  return mesh;
}

TEST(ContactGeometry, TheGroundIsTheTopOfASlabWhateverTheSidesOfItsTriangles) {
  const Mesh slab = thick_slab();
  Mesh doubled = slab, mixed = slab, turned = slab;
  for (const auto& [a, b, c] : slab.triangles) doubled.triangles.push_back({a, c, b});
  for (std::size_t i = 0; i < mixed.triangles.size(); i += 2) std::swap(mixed.triangles[i][1], mixed.triangles[i][2]);
  std::swap(turned.triangles[2][1], turned.triangles[2][2]);  // one half of the top
  std::swap(turned.triangles[0][1], turned.triangles[0][2]);  // one half of the underside
  for (const Mesh& mesh : {slab, doubled, mixed, turned}) {
    for (const std::optional<Eigen::Vector2d>& start :
         {std::optional<Eigen::Vector2d>(), std::optional(Eigen::Vector2d(-3.0, 0.0))}) {
      const ContactGeometry contact = contact_geometry(mesh, {}, {.start = start});
      EXPECT_NEAR(ground_of(contact).T_site_shape.position.z(), 0.0, 1e-6) << contact.rows.front().text;
    }
  }
  EXPECT_THAT(contact_geometry(doubled, {}, {}).rows.front().text, HasSubstr("triangles face both sides"));
}

TEST(ContactGeometry, EnclosesEverySurfaceAndIsNowhereFurtherThanAVoxelFromIt) {
  const Mesh mesh = two_rooms();
  const ContactGeometry contact = contact_geometry(mesh, {}, {});
  EXPECT_EQ(ground_of(contact).type, SiteShapeType::kPlane);
  EXPECT_NEAR(ground_of(contact).T_site_shape.position.z(), 0.0, 1e-6);
  SurfacePoints points(mesh);
  SphereProbe small(contact, 1e-3), free(contact, 0.02);
  int touched = 0, tested = 0;
  for (int i = 0; i < 1500; ++i) {
    const Eigen::Vector3d p = points.draw();
    if (p.z() > 2.45) continue;  // above the height with contact
    ++tested;
    touched += small.touches(p) ? 1 : 0;
  }
  EXPECT_GT(tested, 700);
  EXPECT_EQ(touched, tested);
  const double diagonal_m = 0.05 * std::sqrt(3.0);
  int spurious = 0, in_free = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d p = points.draw_in({Eigen::Vector3d(0.1, 0.1, 0.1), Eigen::Vector3d(7.9, 5.9, 2.4)});
    if (points.distance(p) < 0.02 + diagonal_m) continue;
    ++in_free;
    spurious += free.touches(p) ? 1 : 0;
  }
  EXPECT_GT(in_free, 2000);
  EXPECT_EQ(spurious, 0);
}

TEST(ContactGeometry, ARobotOfHalfAMeterPassesADoorOfOneMeter) {
  SphereProbe robot(contact_geometry(two_rooms(), {}, {}), 0.4);
  const Eigen::Vector3d normal = Eigen::Vector3d(1.0, -0.5, 0.0).normalized(), door(4.45, 3.0, 0.45);
  for (double s = -1.0; s <= 1.0; s += 0.05) EXPECT_FALSE(robot.touches(door + s * normal)) << s;
  EXPECT_TRUE(robot.touches({3.6, 1.25, 0.45}));
}

TEST(ContactGeometry, ConvexObjectsAreTheirHullsAndALShapeIsNot) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0});
  add_box(mesh, {1, 1, 0}, {2, 3, 1});
  add_box(mesh, {4, 4, 0.3}, {5, 5, 0.34});
  const ContactGeometry boxes = contact_geometry(mesh, {}, {});
  EXPECT_EQ(count(boxes, SiteShapeType::kMesh), 2);
  EXPECT_EQ(count(boxes, SiteShapeType::kBox), 0);
  Mesh wall;  // flat, with a door: an L of two quadrilaterals that share an edge
  add_quad(wall, {0, 0, 0}, {1, 0, 0}, {1, 0, 2}, {0, 0, 2});
  add_quad(wall, {1, 0, 1.5}, {2, 0, 1.5}, {2, 0, 2}, {1, 0, 2});
  wall.vertices_m.push_back({1, 0, 1.5});
  add_quad(wall, {0, -4, 0}, {4, -4, 0}, {4, 4, 0}, {0, 4, 0});
  wall.triangles.push_back({1, 4, 2});  // joins the two
  const ContactGeometry open = contact_geometry(wall, {}, {});
  EXPECT_EQ(count(open, SiteShapeType::kMesh), 0);
  SphereProbe probe(open, 0.2);
  EXPECT_FALSE(probe.touches({1.5, 0.0, 0.6}));
  EXPECT_TRUE(probe.touches({0.5, 0.1, 0.6}));
}

TEST(ContactGeometry, TheGroundIsTheFloorAndNotTheRoofTheCeilingOrTheUndersideOfTheSlab) {
  Mesh mesh;
  add_box(mesh, {0, 0, -0.3}, {8, 6, 0});         // slab
  add_box(mesh, {0, 0, 2.8}, {8, 6, 3.1});        // roof
  add_box(mesh, {0.1, 0.1, 0}, {0.3, 5.9, 2.8});  // wall
  const ContactGeometry contact = contact_geometry(mesh, {}, {});
  EXPECT_EQ(ground_of(contact).type, SiteShapeType::kPlane);
  EXPECT_NEAR(ground_of(contact).T_site_shape.position.z(), 0.0, 1e-6);
  EXPECT_EQ(count(contact, SiteShapeType::kMesh), 1);  // the wall
  EXPECT_NEAR(contact.ground_area_m2, 48.0, 1.5);
}

TEST(ContactGeometry, AStartChoosesTheGround) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {8, 0, 0}, {8, 6, 0}, {0, 6, 0});
  add_quad(mesh, {8, 0, 1}, {16, 0, 1}, {16, 6, 1}, {8, 6, 1});
  EXPECT_NEAR(ground_of(contact_geometry(mesh, {}, {})).T_site_shape.position.z(), 0.0, 1.0);
  const ContactGeometry upper = contact_geometry(mesh, {}, {.start = Eigen::Vector2d(12.0, 3.0)});
  EXPECT_NEAR(upper.ground_area_m2, 48.0, 1.0);
  EXPECT_THAT(upper.rows.front().text, HasSubstr("48"));
  try {
    contact_geometry(mesh, {}, {.start = Eigen::Vector2d(30.0, 3.0)});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "--start 30,3: no walkable surface there");
  }
}

/// Crate on a given plane z = 0, and a given deck of 4 x 4 m at z = 1 m above the crate.
TEST(ContactGeometry, AStartBesideTheMeshChoosesTheGivenSurfaceThere) {
  Mesh crate, plane, deck;
  add_box(crate, {0, 0, 0}, {1, 1, 0.5});
  add_quad(plane, {-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
  add_quad(deck, {-1, -1, 1}, {9, -1, 1}, {9, 3, 1}, {-1, 3, 1});
  const ContactGeometry on_plane = contact_geometry(crate, plane, {.start = Eigen::Vector2d(-4.0, 2.0)});
  EXPECT_EQ(on_plane.rows.front().text, "the surfaces with contact of their own");
  EXPECT_EQ(count(on_plane, SiteShapeType::kMesh), 1) << "the crate is above the plane";
  const ContactGeometry on_deck = contact_geometry(crate, deck, {.start = Eigen::Vector2d(8.0, 2.0)});
  EXPECT_EQ(count(on_deck, SiteShapeType::kMesh), 0) << "the crate is below the deck";
  EXPECT_THROW(contact_geometry(crate, deck, {.start = Eigen::Vector2d(8.0, 4.0)}), InputError);
}

TEST(ContactGeometry, AStartOnASlabOf20cmChoosesItsTopAndNotItsUnderside) {
  Mesh slab;
  add_box(slab, {0, 0, -0.2}, {8, 6, 0});
  const ContactGeometry contact = contact_geometry(slab, {}, {.start = Eigen::Vector2d(1, 1)});
  EXPECT_EQ(ground_of(contact).type, SiteShapeType::kPlane);
  EXPECT_NEAR(ground_of(contact).T_site_shape.position.z(), 0.0, 1e-6);
  EXPECT_THAT(contact.rows.front().text, testing::Not(HasSubstr("face down")));
}

TEST(ContactGeometry, WithCellsOf25cmTheGroundOfAHallIsTheTopOfItsSlabOf20cmAndNotTheTopsOfItsWalls) {
  Mesh hall;
  add_box(hall, {0, 0, -0.2}, {12, 8, 0});
  for (const double x : {0.0, 11.5}) add_box(hall, {x, 0, 0}, {x + 0.5, 8, 3});
  const ContactGeometry contact = contact_geometry(hall, {}, {.cell_m = 0.25});
  EXPECT_EQ(ground_of(contact).type, SiteShapeType::kPlane);
  EXPECT_NEAR(ground_of(contact).T_site_shape.position.z(), 0.0, 1e-6);
  EXPECT_NEAR(contact.ground_area_m2, 96.0, 4.0);
}

TEST(ContactGeometry, ARampBecomesAHeightFieldExactToAMillimeterAndAStepOfTwentyCentimetersABox) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
  add_quad(mesh, {4, 0, 0}, {8, 0, 1}, {8, 4, 1}, {4, 4, 0});  // 14 degrees
  const ContactGeometry contact = contact_geometry(mesh, {}, {});
  const SiteShape& ground = ground_of(contact);
  ASSERT_EQ(ground.type, SiteShapeType::kHeightField);
  const Grid<float>& heights = ground.height_field.height_m;
  for (const double x : {1.0, 5.0, 6.5, 7.9}) {
    const Cell cell = heights.geometry().cell_at({x, 2.0});
    const double center = heights.geometry().center_of(cell).x();
    EXPECT_NEAR(double{heights.at(cell)}, std::max(0.0, (center - 4.0) / 4.0), 1e-3) << x;
  }
  EXPECT_EQ(count(contact, SiteShapeType::kBox), 0);
  Mesh steps;
  add_quad(steps, {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
  add_quad(steps, {4, 0, 0}, {4, 4, 0}, {4, 4, 0.2}, {4, 0, 0.2});
  add_quad(steps, {4, 0, 0.2}, {4.5, 0, 0.2}, {4.5, 4, 0.2}, {4, 4, 0.2});
  const ContactGeometry curb = contact_geometry(steps, {}, {});
  double top = 0.0;
  for (const SiteShape& shape : curb.shapes) {
    if (shape.type == SiteShapeType::kBox) top = std::max(top, shape.T_site_shape.position.z() + shape.size_m.z());
    if (shape.type == SiteShapeType::kMesh) {
      for (const Eigen::Vector3d& v : shape.mesh.vertices_m) top = std::max(top, v.z());
    }
  }
  EXPECT_EQ(ground_of(curb).type, SiteShapeType::kPlane);
  EXPECT_NEAR(top, 0.2, 0.011);
}

TEST(ContactGeometry, ADropBesideTheGroundStaysADrop) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {6, 0, 0}, {6, 6, 0}, {0, 6, 0});
  add_quad(mesh, {6, 0, -1}, {7, 0, -1}, {7, 6, -1}, {6, 6, -1});  // pit of 6 m2
  const ContactGeometry contact = contact_geometry(mesh, {}, {.start = Eigen::Vector2d(3.0, 3.0)});
  ASSERT_EQ(ground_of(contact).type, SiteShapeType::kHeightField);
  const Grid<float>& heights = ground_of(contact).height_field.height_m;
  EXPECT_NEAR(double{heights.at(heights.geometry().cell_at({6.5, 3.0}))}, -1.0, 1e-3);
  EXPECT_NEAR(double{heights.at(heights.geometry().cell_at({5.5, 3.0}))}, 0.0, 1e-3);
}

TEST(ContactGeometry, GivenSurfacesAreGroundWithoutAnotherOne) {
  Mesh given, mesh;
  add_quad(given, {-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
  add_box(mesh, {1, 1, 0}, {2, 2, 1}, true);  // seen from inside: boxes
  const ContactGeometry contact = contact_geometry(mesh, given, {});
  EXPECT_EQ(contact.shapes.front().type, SiteShapeType::kBox);
  EXPECT_THAT(contact.rows.front().text, HasSubstr("contact of their own"));
}

TEST(ContactGeometry, AnObjectOnAGivenFloorIsNoGround) {
  Mesh given;
  add_quad(given, {-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
  const auto first_row = [&given](const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
    Mesh mesh;
    add_box(mesh, lower, upper);
    return contact_geometry(mesh, given, {}).rows.front().text;
  };
  const char* floor = "contact of their own";
  EXPECT_THAT(first_row({1, 1, 0.02}, {1.5, 1.5, 0.5}), HasSubstr(floor)) << "chair";
  EXPECT_THAT(first_row({1, 1, 1.2}, {1.05, 1.6, 1.6}), HasSubstr(floor)) << "sign";
  EXPECT_THAT(first_row({1, 1, 0.02}, {2.5, 2.5, 1}), HasSubstr(floor)) << "crate";
  EXPECT_THAT(first_row({1, 1, 0.02}, {7, 3.4, 2.6}), HasSubstr(floor)) << "container";
  EXPECT_THAT(first_row({1, 1, -0.1}, {9, 7, 0.25}), HasSubstr("48 m2 of walkable surface")) << "slab of a house";
}

TEST(ContactGeometry, TheGroundOfABuildingWhoseTrianglesFaceInwardIsTheTopOfItsSlab) {
  Mesh mesh;
  add_box(mesh, {-5, -4, -0.25}, {5, 4, 0}, true);
  add_box(mesh, {-5, -4, 0}, {-4.8, 4, 2.5}, true);
  add_box(mesh, {4.8, -4, 0}, {5, 4, 2.5}, true);
  add_box(mesh, {-5, -4, 2.5}, {5, 4, 2.75}, true);
  for (const std::optional<Eigen::Vector2d>& start :
       {std::optional<Eigen::Vector2d>(), std::optional(Eigen::Vector2d(-3.0, 0.0))}) {
    const ContactGeometry contact = contact_geometry(mesh, {}, {.start = start});
    EXPECT_NEAR(ground_of(contact).T_site_shape.position.z(), 0.0, 1e-6);
    EXPECT_THAT(contact.rows.front().text, HasSubstr("whose triangles face down"));
  }
}

TEST(ContactGeometry, AFanOfSliversIsWholeGround) {
  Mesh mesh;  // disk of 20 m radius: 4,000 triangles across thousands of cells
  constexpr int kNum = 4000;
  mesh.vertices_m.emplace_back(0, 0, 0);
  for (int i = 0; i < kNum; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kNum;
    mesh.vertices_m.emplace_back(20.0 * std::cos(angle), 20.0 * std::sin(angle), 0.0);
    mesh.triangles.push_back({0, i + 1, (i + 1) % kNum + 1});
  }
  EXPECT_NEAR(contact_geometry(mesh, {}, {}).ground_area_m2, std::numbers::pi * 400.0, 2.0);
}

TEST(ContactGeometry, TheCellGrowsWithTheSiteAndIsReported) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {300, 0, 0}, {300, 300, 0}, {0, 300, 0});
  const ContactGeometry contact = contact_geometry(mesh, {}, {.max_cells = 1'000'000});
  EXPECT_THAT(contact.rows.back().text, HasSubstr("cells of 0.4 m"));
}

TEST(ContactGeometry, TheRowOfALevelGroundHasItsHeightWithoutTheDigitsOfRounding) {
  for (const auto& [height_m, text] :
       {std::pair(-4.47e-10, "a level plane at 0 m,"), {0.25, "a level plane at 0.25 m,"}}) {
    Mesh floor;
    add_quad(floor, {0, 0, height_m}, {4, 0, height_m}, {4, 4, height_m}, {0, 4, height_m});
    EXPECT_THAT(contact_geometry(floor, {}, {}).rows.front().text, HasSubstr(text));
  }
}

}  // namespace
}  // namespace patrol::importer::contact_geometry_test
