#pragma once

#include <filesystem>
#include <vector>

#include "core/pose_relation.h"

namespace patrol::io {

/// The Freiburg benchmark's reference relations: "t1 t2 x y z roll pitch yaw" a line (s, m, rad), the pose at t2 seen from that at t1;
/// '#' begins a comment. Of the pose its x, y and yaw are used. Throws InputError with file and line for anything else, and for a file
/// without relations.
std::vector<PoseRelation> load_relations(const std::filesystem::path& file);

}  // namespace patrol::io
