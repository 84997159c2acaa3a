#include "importer/robot/link_builder.h"

#include <fmt/format.h>

#include "importer/hull.h"

namespace patrol::importer {
namespace {

constexpr std::size_t kManyTriangles = 20000;

}  // namespace

LinkBuilder::LinkBuilder(const RobotLayout& layout, NormalizedRobot& robot) : layout_(layout), robot_(robot) {
  // No link of the file may have the name of one of Patrol's own frames by chance.
  for (const char* name : {"base_link", "world"}) used_links_.reserve(name);
  for (const char* frame : kSensorFrames) used_links_.reserve(frame);
}

std::string LinkBuilder::link_name(const std::string& source_name) {
  if (source_name == layout_.base) return "base_link";
  if (const auto found = link_names_.find(source_name); found != link_names_.end()) return found->second;
  const std::string name =
      used_links_.unique(is_reserved_link(source_name) ? source_name + "_part" : source_name, "_part");
  link_names_[source_name] = name;
  robot_.source_links[name] = source_name;
  if (name != source_name) {
    robot_.assumptions.push_back(
        {source_name, fmt::format("is renamed to {}: the name has a meaning in Patrol", name), "name of the link"});
  }
  return name;
}

std::string LinkBuilder::joint_name(const std::string& source_name) {
  if (const auto found = joint_names_.find(source_name); found != joint_names_.end()) return found->second;
  const std::string name =
      used_joints_.unique(is_reserved_joint(source_name) ? "joint_" + source_name : source_name, "_joint");
  joint_names_[source_name] = name;
  return name;
}

std::optional<std::string> LinkBuilder::added_name(const std::string& source_name) const {
  const auto found = link_names_.find(source_name);
  return found == link_names_.end() ? std::nullopt : std::optional(found->second);
}

std::string LinkBuilder::add_mesh(const std::string& stem, const Mesh& mesh) {
  const std::string name = used_files_.unique(file_stem(stem), "") + ".obj";
  robot_.meshes.emplace_back(name, to_obj(mesh));
  return "meshes/" + name;
}

/// Returns the files of the parts of a visual mesh. Links share them.
const std::vector<LinkBuilder::ColoredFile>& LinkBuilder::files_of(const Shape& visual) {
  std::vector<ColoredFile>& files = mesh_files_[visual.mesh.get()];
  if (!files.empty()) return files;
  for (const MeshPart& part : *visual.mesh) {
    const std::string file = add_mesh(visual.mesh_name, part.mesh);
    files.emplace_back(file, part.has_color ? std::optional(part.rgba) : std::nullopt);
    if (part.mesh.triangles.size() <= kManyTriangles) continue;
    robot_.assumptions.push_back({file,
                                  fmt::format("has {} triangles and slows rendering down: at most {} are advised",
                                              part.mesh.triangles.size(), kManyTriangles),
                                  "<mesh filename> of the visual"});
  }
  return files;
}

void LinkBuilder::add_visuals(const SourceLink& link, const Pose3& T_new_link, NormalizedLink& target) {
  for (const Shape& visual : link.visuals) {
    Shape shape = visual;
    shape.T_link_shape = T_new_link * visual.T_link_shape;
    if (visual.type != ShapeType::kMesh) {
      target.visuals.push_back({.shape = shape, .rgba = visual.rgba});
      continue;
    }
    for (const auto& [file, color] : files_of(visual))
      target.visuals.push_back({.shape = shape, .mesh_file = file, .rgba = visual.rgba ? visual.rgba : color});
  }
}

/// Returns the files of the convex pieces of a collision mesh. Links share them.
const std::vector<std::string>& LinkBuilder::hulls_of(const Shape& shape, const SourceLink& link) {
  std::vector<std::string>& files = hull_files_[shape.mesh.get()];
  if (!files.empty()) return files;
  const ConvexPieces pieces = convex_pieces(whole_mesh(shape));
  for (const Mesh& piece : pieces.pieces) files.push_back(add_mesh(shape.mesh_name + "_hull", piece));
  if (pieces.pieces.empty()) {
    layout_.source.fail(
        shape.line, link.name,
        fmt::format("collision mesh {} has no surface: must have triangles with an area", shape.mesh_name));
  }
  robot_.assumptions.push_back(
      {link.name,
       fmt::format("collision mesh {} is replaced by {} convex piece{}, the hulls of its connected components{}{}",
                   shape.mesh_name, pieces.pieces.size(), pieces.pieces.size() == 1 ? "" : "s",
                   pieces.num_dropped > 0 ? fmt::format("; {} small or enclosed ones are left out", pieces.num_dropped)
                                          : "",
                   pieces.num_merged > 0 ? fmt::format("; {} are merged with a neighbor", pieces.num_merged) : ""),
       "<collision> of the link"});
  return files;
}

void LinkBuilder::add_collisions(const SourceLink& link, const Pose3& T_new_link, bool from_visuals,
                                 NormalizedLink& target) {
  const std::vector<Shape>& shapes = from_visuals ? link.visuals : link.collisions;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (!from_visuals && layout_.support_shapes.contains({link.name, i})) continue;
    Shape shape = shapes[i];
    shape.T_link_shape = T_new_link * shape.T_link_shape;
    if (shape.type != ShapeType::kMesh) {
      if (shape.type == ShapeType::kBox && shape.size_m.minCoeff() <= 0.0) continue;
      target.collisions.push_back({.shape = shape});
      continue;
    }
    for (const std::string& file : hulls_of(shape, link))
      target.collisions.push_back({.shape = shape, .mesh_file = file});
  }
}

}  // namespace patrol::importer
