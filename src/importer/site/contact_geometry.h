#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "importer/assumptions.h"
#include "importer/mesh.h"
#include "importer/site/imported_site.h"

namespace patrol::importer {

/// Options of `contact_geometry`.
struct ContactOptions {
  double cell_m = 0.05;                       ///< side of the cells of the ground and of the boxes
  double height_m = 2.5;                      ///< surfaces up to this height above the ground have contact, at most 3
  std::optional<Eigen::Vector2d> start = {};  ///< point in site on the ground; none: by rule
  std::size_t max_cells = 6'000'000;          ///< the cell is doubled until the site has at most this number
  std::size_t max_boxes = 60'000;             ///< the cell is doubled, at most twice, above this number of boxes
};

/// Contact geometry of triangles.
struct ContactGeometry {
  std::vector<SiteShape> shapes = {};  ///< kContactOnly, of material kContactMaterial, named contact_*
  std::vector<Assumption> rows = {};   ///< ground, numbers of shapes, cell
  double ground_area_m2 = 0.0;
};

/// Name of the material of all contact shapes.
constexpr const char* kContactMaterial = "contact";

/// Returns the material of all contact shapes, which no camera and no lidar sees.
SiteMaterial contact_material();

/// Makes contact geometry for triangles, because MuJoCo collides a mesh by its convex hull. Connected components that
/// are convex to 2 cm become their hulls. The ground becomes a plane if it is level to 1 cm, otherwise a height field.
/// It is the connected surface, walkable (slope up to 45 degrees, steps up to a cell, 0.2 m of free height), that
/// contains `start`; else, of those that face up, have 1 m of free height and at least a quarter of the largest area,
/// the lowest. Given surfaces below the mesh are the ground if the mesh has no surface of 1 m2, or only the top of an
/// object below 20 m2, more than 0.3 m above them. All other surfaces up to `height_m` above the ground become boxes of
/// whole cells, exact to 1 cm in height, and merged where tops are equal. Surfaces below the ground and above that
/// height have no contact.
///
/// `mesh`: triangles in site, z up. `given`: surfaces with contact of their own, which take part in the search for the
/// ground only. Throws InputError without file if there is no walkable surface at `start`, or for coordinates above
/// 100 km.
ContactGeometry contact_geometry(const Mesh& mesh, const Mesh& given, const ContactOptions& options);

}  // namespace patrol::importer
