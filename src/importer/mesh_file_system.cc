#include "importer/mesh_file_system.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include <assimp/MemoryIOWrapper.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "io/files/atomic_file.h"

namespace patrol::importer {

std::string with_leading_digits(const std::string& obj) {
  std::string result;
  bool is_line_start = true, is_vertex = false, is_after_blank = false;
  for (std::size_t i = 0; i < obj.size(); ++i) {
    const char c = obj[i];
    const bool is_blank = c == ' ' || c == '\t';
    if (is_line_start && !is_blank) {
      is_vertex = c == 'v';
      is_line_start = false;
    }
    const bool has_digit = i + 1 < obj.size() && std::isdigit(static_cast<unsigned char>(obj[i + 1])) != 0;
    if (is_vertex && is_after_blank && c == '.' && has_digit) result += '0';
    result += c;
    is_after_blank = is_blank;
    if (c == '\n' || c == '\r') is_line_start = true;
  }
  return result;
}

Assimp::IOStream* MeshFileSystem::Open(const char* file, const char* mode) {
  if (to_lower(std::filesystem::path(file).extension().string()) == ".obj" && mode[0] == 'r') {
    try {
      const std::string text = io::load_text(file), changed = with_leading_digits(text);
      if (changed.size() != text.size()) {
        auto* const bytes = new std::uint8_t[changed.size()];  // the stream deletes it
        std::copy(changed.begin(), changed.end(), bytes);
        return new Assimp::MemoryIOStream(bytes, changed.size(), true);
      }
    } catch (const InputError&) {
      // The caller reports a file that cannot be opened.
    }
  }
  return DefaultIOSystem::Open(file, mode);
}

}  // namespace patrol::importer
