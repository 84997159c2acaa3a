#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "importer/site/contact_geometry.h"
#include "importer/site/mesh_scene.h"
#include "importer/site/site_import.h"

namespace patrol::importer {

/// Reads a glTF, GLB, OBJ, DAE, PLY or STL file as a site. Cameras and lidars see its triangles, contact is that of
/// `contact_geometry`. Uses `scale`, `up`, `start` and `contact_cell_m`. Throws InputError with the file.
ImportedSite read_mesh_site(const SiteImportOptions& options);

/// Meters per unit and axis that points up of a mesh file, by its format, the options, or rules:
/// meters, unless the file is then longer than 1,000 m or higher than 100 m: centimeters or millimeters, whichever
/// gives a height nearer to 5 m. The axis, y or z, whose surfaces facing along it have the larger area in the lowest
/// third.
struct SceneFrame {
  double unit_m = 1.0;
  char up = 'z';
  std::vector<Assumption> rows = {};
};
SceneFrame frame_of(const MeshScene& scene, double scale, const std::string& up);

/// Turns the axis `up` of a scene to z, and scales its units to meters. Right-handed.
void to_site_axes(MeshScene& scene, const SceneFrame& frame);

/// Returns the parts of a scene as shapes that cameras and lidars see, with names NAME_1, NAME_2 and so on, and the
/// materials of the scene. Parts that are not closed have a second mesh for cameras,
/// because MuJoCo draws the front of triangles only.
std::vector<SiteShape> seen_shapes(const MeshScene& scene, const std::string& name);

/// Returns the options for the contact geometry of a site.
ContactOptions contact_options(const SiteImportOptions& options);

}  // namespace patrol::importer
