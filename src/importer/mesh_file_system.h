#pragma once

#include <string>

#include <assimp/DefaultIOSystem.h>

namespace patrol::importer {

/// Returns OBJ text in which the numbers of vertices have a digit before the point: `0.6` for `.6`.
std::string with_leading_digits(const std::string& obj);

/// File access for libassimp. Its reader of OBJ files takes no number that starts with a point: it is given the text of
/// `with_leading_digits`.
class MeshFileSystem : public Assimp::DefaultIOSystem {
 public:
  Assimp::IOStream* Open(const char* file, const char* mode) override;
};

}  // namespace patrol::importer
