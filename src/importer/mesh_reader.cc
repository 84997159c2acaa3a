#include "importer/mesh_reader.h"

#include <algorithm>
#include <utility>

#include <assimp/config.h>
#include <fmt/format.h>

#include "core/error.h"
#include "importer/mesh_file_system.h"
#include "importer/mesh_text.h"

namespace patrol::importer {

MeshReader::MeshReader(std::filesystem::path file) : file_(std::move(file)) {
  importer_.SetIOHandler(new MeshFileSystem);  // the importer deletes it
  importer_.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer_.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_LINE | aiPrimitiveType_POINT);
  importer_.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, 40.0F);
}

const aiScene& MeshReader::read(unsigned steps) { return checked(importer_.ReadFile(file_.string(), steps)); }

const aiScene& MeshReader::process(unsigned steps) { return checked(importer_.ApplyPostProcessing(steps)); }

const aiScene& MeshReader::checked(const aiScene* scene) const {
  if (scene != nullptr && scene->mRootNode != nullptr) return *scene;
  throw InputError(fmt::format("{}: mesh cannot be read: {}", file_.string(), mesh_error(importer_.GetErrorString())));
}

void check_finite(const Mesh& mesh, const std::filesystem::path& file) {
  if (!std::ranges::all_of(mesh.vertices_m, [](const Eigen::Vector3d& vertex) { return vertex.allFinite(); }))
    throw InputError(file.string() + ": mesh has vertices that are not finite");
}

}  // namespace patrol::importer
