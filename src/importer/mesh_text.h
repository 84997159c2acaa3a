#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patrol::importer {

/// Checks the text of an OBJ, an ASCII STL or an ASCII PLY file, and the size of a binary STL file, because libassimp
/// reports neither line nor cause and reads incomplete rows of PLY. Throws InputError "file:line: key: what" for
/// numbers and indices of vertices that are invalid, facets and rows with a wrong number of values, and files that end
/// early. Other files are accepted.
void check_mesh_text(const std::filesystem::path& file);

/// Returns the beginning of a message of libassimp, which may contain the rest of the file, on one line.
std::string mesh_error(std::string_view message);

}  // namespace patrol::importer
