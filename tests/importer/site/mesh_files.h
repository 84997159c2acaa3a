#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "importer/mesh.h"
#include "importer/site/imported_site.h"
#include "importer/site/site_import.h"
#include "sim/mujoco.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer {

/// Appends a quadrilateral, counterclockwise seen from its front.
inline void add_quad(Mesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& d) {
  const int first = static_cast<int>(mesh.vertices_m.size());
  for (const Eigen::Vector3d& corner : {a, b, c, d}) mesh.vertices_m.push_back(corner);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// Appends a box between two corners, seen from outside; from inside if `is_room`.
inline void add_box(Mesh& mesh, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, bool is_room = false) {
  const auto at = [&](int x, int y, int z) {
    return Eigen::Vector3d(x ? upper.x() : lower.x(), y ? upper.y() : lower.y(), z ? upper.z() : lower.z());
  };
  const std::array<std::array<Eigen::Vector3d, 4>, 6> faces = {{{at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)},
                                                                {at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)},
                                                                {at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)},
                                                                {at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)},
                                                                {at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)},
                                                                {at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)}}};
  for (const auto& f : faces) {
    if (is_room) add_quad(mesh, f[3], f[2], f[1], f[0]);
    else add_quad(mesh, f[0], f[1], f[2], f[3]);
  }
}

/// Text of a glTF file with its buffer in base64: one mesh, positions as they are, and more JSON at the places.
struct GltfText {
  std::string material = R"({"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,1]}})";
  std::string node = R"("mesh":0)";
  std::string more = "";  ///< members of the root, each with a comma before it
  std::vector<Eigen::Vector2d> uv = {};

  static std::string base64(const std::string& bytes) {
    static constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t bits = 0;
      for (std::size_t k = 0; k < 3; ++k)
        bits = bits << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
      for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
    }
    return text;
  }

  std::string of(const Mesh& mesh) const {
    std::string bytes;
    const auto put = [&](auto value) {
      std::array<char, sizeof value> raw{};
      std::memcpy(raw.data(), &value, sizeof value);
      bytes.append(raw.data(), raw.size());
    };
    for (const Eigen::Vector3d& v : mesh.vertices_m) {
      for (int k = 0; k < 3; ++k) put(static_cast<float>(v[k]));
    }
    const std::size_t uv_at = bytes.size();
    for (const Eigen::Vector2d& v : uv) put(static_cast<float>(v.x())), put(static_cast<float>(v.y()));
    const std::size_t faces_at = bytes.size();
    for (const auto& t : mesh.triangles) {
      for (const int i : t) put(static_cast<std::uint32_t>(i));
    }
    const std::size_t n = mesh.vertices_m.size();
    const std::string uv_attribute = uv.empty() ? "" : R"(,"TEXCOORD_0":2)";
    const std::string uv_accessor =
        uv.empty() ? "" : fmt::format(R"(,{{"bufferView":2,"componentType":5126,"count":{},"type":"VEC2"}})", n);
    const std::string uv_view =
        uv.empty() ? "" : fmt::format(R"(,{{"buffer":0,"byteOffset":{},"byteLength":{}}})", uv_at, 8 * n);
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{{}}}],)"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0{}}},"indices":1,"material":0}}]}}],"materials":[{}],)"
        R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)"
        R"({{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}{}],)"
        R"("bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}{}],)"
        R"("buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}}]{}}})",
        node, uv_attribute, material, n, 3 * mesh.triangles.size(), uv_accessor, 12 * n, faces_at,
        12 * mesh.triangles.size(), uv_view, bytes.size(), base64(bytes), more);
  }
};

/// File in a folder of its own, imported as a site named "site".
class SiteFileImport {
 public:
  SiteFileImport(const std::string& file, const std::string& text) {
    options.file = folder / file;
    options.name = "site";
    test::write_bytes(options.file, text);
  }

  const ImportedSite& read() { return site = import_site(options); }

  /// Imports and writes; returns the compiled model.
  sim::ModelPtr model() {
    read();
    write_site(site, folder / "site");
    return sim::compile(*sim::load_spec((folder / "site/site.xml").string()), "site.xml");
  }

  std::string xml() const { return (folder / "site/site.xml").string(); }

  /// Returns the message of the InputError, without the folder; "accepted" if there is none.
  std::string error() {
    try {
      model();
    } catch (const std::exception& error) {
      std::string text = error.what();
      const std::string prefix = folder.path().string() + "/";
      for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
        text.erase(at, prefix.size());
      return text;
    }
    return "accepted";
  }

  /// Text of the assumption about a subject; empty if there is none.
  std::string assumption(const std::string& subject) const {
    for (const Assumption& row : site.assumptions) {
      if (row.subject == subject) return row.text;
    }
    return {};
  }

  test::TemporaryFolder folder;
  SiteImportOptions options;
  ImportedSite site;
};

}  // namespace patrol::importer
