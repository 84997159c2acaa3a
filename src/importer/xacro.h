#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "importer/assumptions.h"
#include "importer/packages.h"

namespace patrol::importer {

/// Returns whether the name of the file ends in `.xacro`.
bool is_xacro(const std::filesystem::path& file);

/// Returns whether a text is XML with elements of xacro, or with "$(" or "${" in an attribute of the robot, outside of
/// the elements of Gazebo.
bool has_xacro_text(const std::string& text);

/// Options of an expansion by xacro.
struct XacroOptions {
  std::map<std::string, std::string> arguments = {};           ///< by name
  std::map<std::string, std::filesystem::path> packages = {};  ///< folders of packages, by name
  std::string python = "python3";                              ///< interpreter that has the package xacro
};

/// Text of a file that may need xacro.
struct ExpandedFile {
  std::string text;
  std::string label;                  ///< for messages: the file, with "(expanded)" if the lines are not its own
  std::vector<Assumption> rows = {};  ///< whether the file is expanded although its name does not end in `.xacro`
};

/// Reads a file, and expands it by `expand_xacro` if it needs xacro by its name or its text. Throws InputError as that
/// function.
ExpandedFile load_expanded(const std::filesystem::path& file, const XacroOptions& options);

/// Expands a xacro file by the Python package xacro, without ROS, with the interpreter of the options, or the one that
/// the environment variable PATROL_PYTHON names. Throws InputError with the file and xacro's message in one line if the
/// package is missing or the expansion fails.
std::string expand_xacro(const std::filesystem::path& file, const XacroOptions& options);

}  // namespace patrol::importer
