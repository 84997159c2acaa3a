#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "importer/assumptions.h"
#include "importer/packages.h"

namespace tinyxml2 {
class XMLDocument;
}

namespace patrol::importer {

/// Attribute of the elements of an expanded text: "FILE:LINE" of the element in its xacro file.
inline constexpr const char* kPositionAttribute = "patrol-position";

/// Returns whether the name of the file ends in `.xacro`.
bool is_xacro(const std::filesystem::path& file);

/// Returns whether a text is XML with elements of xacro, or with "$(" or "${" in an attribute of the robot, outside of
/// the elements of Gazebo.
bool has_xacro_text(const std::string& text);

/// Options of an expansion by xacro.
struct XacroOptions {
  std::map<std::string, std::string> arguments = {};           ///< values of the arguments, by name
  std::map<std::string, std::filesystem::path> packages = {};  ///< folders of packages, by name
  std::string python = "python3";                              ///< interpreter that has the package xacro
};

/// Text of a file that may need xacro.
struct ExpandedFile {
  std::string text;
  bool is_expanded = false;           ///< the lines of the text are not those of the file
  std::vector<Assumption> rows = {};  ///< whether the file is expanded although its name does not end in `.xacro`
};

/// Reads a file, and expands it by `expand_xacro` if it needs xacro by its name or its text. Throws InputError as that
/// function, and for arguments of a file that does not need xacro.
ExpandedFile load_expanded(const std::filesystem::path& file, const XacroOptions& options);

/// Expands a xacro file by the Python package xacro, without ROS, with the interpreter of the options, or the one that
/// the environment variable PATROL_PYTHON names. Throws InputError in one line if the package is missing, for an
/// argument that the files do not read, and if the expansion fails: with file and line of the element and xacro's
/// message.
std::string expand_xacro(const std::filesystem::path& file, const XacroOptions& options);

/// Returns the positions of the elements of an expanded text by their line in it, and removes the attributes; empty for
/// another text.
std::map<int, std::string> take_positions(tinyxml2::XMLDocument& document);

/// Returns "FILE:LINE" for messages: with positions in the xacro file that has the element of the line, or `file` alone
/// for a line without a position; without positions, `file` and the line if it is positive.
std::string location_in(const std::string& file, const std::map<int, std::string>& positions, int line);

}  // namespace patrol::importer
