#pragma once

#include <filesystem>
#include <vector>

#include "core/pose_relation.h"

namespace patrol::io {

/// Reads the reference relations of the Freiburg SLAM benchmark [Kuemmerle09]. Format: "t1 t2 x y z roll pitch yaw" per
/// line (s, m, rad), the pose at t2 relative to that at t1; '#' starts a comment. Only x, y and yaw are used. Throws
/// InputError with file and line for an invalid line, and for a file without relations.
std::vector<PoseRelation> load_relations(const std::filesystem::path& file);

}  // namespace patrol::io
