#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/grid.h"
#include "core/route.h"
#include "importer/assumptions.h"
#include "importer/mesh.h"
#include "sim/mujoco.h"
#include "sim/site_settings.h"

namespace patrol::importer {

/// Maximum absolute coordinate of a site: the floats of lidars and cameras are 8 mm apart there.
inline constexpr double kMaxCoordinate_m = 1e5;

/// Returns the text that refuses larger coordinates.
std::string far_text(double coordinate_m);

/// Use of a shape of a site. Physics keeps the shapes with contact only.
enum class ShapeUse : std::uint8_t {
  kSolid,        ///< visible to cameras and lidars, with contact
  kSeen,         ///< visible to cameras and lidars, without contact
  kVisualOnly,   ///< visible to cameras only
  kLidarOnly,    ///< visible to lidars only
  kContactOnly,  ///< contact only
};

/// Type of a shape of a site.
enum class SiteShapeType : std::uint8_t { kBox, kCylinder, kSphere, kPlane, kMesh, kHeightField, kCapsule, kEllipsoid };

/// Heights on a regular grid; the height of a vertex is that of the surface at the cell's center; the
/// geom ends at the centers of the outermost cells.
struct HeightField {
  Grid<float> height_m;              ///< in the frame of the shape
  std::vector<char> is_ground = {};  ///< [cell]; 0: a drop, or filled in; empty: all are ground
};

/// Shape of a site. Lengths are in meters.
struct SiteShape {
  std::string name;  ///< unique within the site
  SiteShapeType type = SiteShapeType::kBox;
  ShapeUse use = ShapeUse::kSolid;
  Pose3 T_site_shape = {};
  /// Box: half sizes. Cylinder along z: radius, half length, 0. Capsule along z: radius, half length
  /// between the centers of its ends, 0. Ellipsoid: its radii. Sphere: radius, 0, 0. Plane: half sizes of the drawn
  /// part, 0 for infinite; it is infinite for contact and lidar.
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  std::string material;  ///< name of a material of the site
  Mesh mesh = {};        ///< mesh of a shape kMesh; with contact, MuJoCo uses its convex hull
  std::vector<Eigen::Vector2d> texture_coordinates = {};  ///< [vertex of the mesh]; empty: none
  HeightField height_field = {};                          ///< height field of a shape kHeightField
};

/// Material of a site. The luminance of its color is the reflectivity for lidars (sim/sensors/surface_optics.h); a
/// material with "glass" in its name lets beams through.
struct SiteMaterial {
  std::string name;  ///< unique within the site
  Eigen::Vector4d rgba = {0.7, 0.7, 0.7, 1.0};
  std::string texture = {};       ///< file below textures/; empty: none
  double texture_length_m = 1.0;  ///< length that the image covers; 0: by the texture coordinates of the shapes
};

/// File to be written below the folder of a site.
struct SiteFile {
  std::string path;     ///< "textures/wall.png"
  std::string content;  ///< bytes
};

/// Site in Patrol's form, not yet written. All poses are in the frame `site`, z up.
struct ImportedSite {
  std::string name;       ///< name of the site, its folder and its files
  std::string source;     ///< path of the file that it was read from
  std::string mjcf = {};  ///< model of the site, which replaces materials and shapes; empty: made of these
  std::vector<SiteMaterial> materials = {};
  std::vector<SiteShape> shapes = {};
  std::vector<SiteFile> files = {};           ///< textures and other files of the shapes
  sim::GroundSettings ground = {};            ///< written to NAME.yaml
  std::optional<OccupancyGrid> map = {};      ///< floor plan in `site`, written to map/ for runs on a known map
  std::optional<Route> route = {};            ///< mission in `site`; none: neither routes/ nor scenarios/ are written
  Pose2 T_site_start = {};                    ///< start of the mission
  std::string scenario_keys = {};             ///< further lines of the scenario
  std::string stack_keys = {};                ///< further lines of its section `stack`
  std::string robot = "wheeled";              ///< robot of the scenario
  std::optional<double> lidar_height_m = {};  ///< height of the robot's lidar above the ground; none: without a lidar
  std::vector<Assumption> assumptions = {};

  /// Returns the name of the file without its folder, on one line.
  std::string source_name() const;
};

/// Makes the height fields with contact ground of the site: on a slope, the wheels of a robot are at different heights.
void use_height_fields_as_ground(ImportedSite& site);

/// Returns the MJCF of a site, in which meshes, height fields and textures are files below its folder.
std::string to_mjcf(const ImportedSite& site);

/// Writes NAME.xml, NAME.yaml, README.md with the assumptions, meshes/, textures/, for a floor plan map/, and for a
/// mission routes/patrol.json and scenarios/patrol.yaml: first into a folder beside it, in which MuJoCo compiles the
/// site, then renamed. Throws InputError if the folder exists and is not empty, cannot be written, or MuJoCo refuses
/// the site, or if it is beyond `kMaxCoordinate_m`; nothing is left behind then. Returns the assumptions with those
/// about the compiled site (compiled_site.h), or none, with nothing left behind, if `is_interrupted` returns true
/// before or after the compilation.
std::optional<std::vector<Assumption>> write_site(const ImportedSite& site, const std::filesystem::path& folder,
                                                  const std::function<bool()>& is_interrupted = {});

/// Compiles a site without writing its folder: its files lie in a temporary folder meanwhile. Throws InputError if
/// MuJoCo refuses the site, or if it is beyond `kMaxCoordinate_m`.
sim::ModelPtr compile_site(const ImportedSite& site);

/// Returns a Markdown page with the numbers of shapes and triangles and a table of assumptions.
std::string report_of(const ImportedSite& site, const std::vector<Assumption>& assumptions);

}  // namespace patrol::importer
