#include "importer/site/mesh_checks.h"

#include <string>
#include <string_view>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "importer/mesh_text.h"
#include "io/files/atomic_file.h"
#include "io/files/xml_problem.h"

namespace patrol::importer {
namespace {

[[noreturn]] void refuse_mesh(const std::filesystem::path& file, const std::string& why) {
  throw InputError(fmt::format("{}: mesh cannot be read: {}", file.string(), why));
}

void check_ply_header(const std::filesystem::path& file) {
  constexpr std::string_view kEnd = "end_header";
  const std::string text = io::load_text(file);
  const std::size_t end = text.find(kEnd);
  const std::size_t after = end == std::string::npos ? end : end + kEnd.size();
  const bool is_complete = after < text.size() && (text[after] == '\n' || text[after] == '\r');
  if (!text.starts_with("ply") || !is_complete) refuse_mesh(file, "the header of a PLY file is incomplete");
}

void check_integers(const std::filesystem::path& file, const tinyxml2::XMLElement& element) {
  const std::string_view name = element.Name();
  const bool is_list = name == "p" || name == "h" || name == "v" || name == "vcount";
  const char* text = element.GetText();
  if (is_list && text != nullptr &&
      std::string_view(text).find_first_not_of("-0123456789 \t\r\n") != std::string::npos) {
    throw InputError(fmt::format("{}:{}: <{}>: must be integers", file.string(), element.GetLineNum(), name));
  }
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    check_integers(file, *child);
}

void check_collada(const std::filesystem::path& file) {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS || document.RootElement() == nullptr)
    throw input_error(file.string(), document.ErrorLineNum(), "not XML: " + io::xml_problem(document));
  check_integers(file, *document.RootElement());
}

}  // namespace

void check_mesh_file(const std::filesystem::path& file) {
  const std::string extension = to_lower(file.extension().string());
  if (extension == ".ply") check_ply_header(file);
  if (extension == ".dae") check_collada(file);
  check_mesh_text(file);
}

void check_faces(const std::filesystem::path& file, const aiScene& scene) {
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    bool has_polygon = false;
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
      const aiFace& face = mesh.mFaces[k];
      has_polygon |= face.mNumIndices > 3;
      if (face.mNumIndices == 0) refuse_mesh(file, fmt::format("face {} has no vertices", k));
      for (unsigned corner = 0; corner < face.mNumIndices; ++corner) {
        if (face.mIndices[corner] >= mesh.mNumVertices)
          refuse_mesh(file, fmt::format("face {} has vertex {} of {}: the file is damaged or ends too early", k,
                                        face.mIndices[corner], mesh.mNumVertices));
      }
    }
    const bool is_marked = (mesh.mPrimitiveTypes & aiPrimitiveType_POLYGON) != 0;
    if (is_marked && !has_polygon) refuse_mesh(file, "its polygons are incomplete");
  }
}

}  // namespace patrol::importer
