#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "importer/packages.h"

namespace patrol::importer {

/// Returns whether the name of the file ends in `.xacro`.
bool is_xacro(const std::filesystem::path& file);

/// Returns whether a text is XML with elements of xacro, or with "$(" or "${" in an attribute of the robot, outside of
/// the elements of Gazebo.
bool has_xacro_text(const std::string& text);

/// Expands a xacro file by the Python package xacro, without ROS, with the interpreter `python`, or the one that the
/// environment variable PATROL_PYTHON names. Throws InputError with the file and xacro's message in one line if the
/// package is missing or the expansion fails.
std::string expand_xacro(const std::filesystem::path& file, const std::map<std::string, std::string>& arguments,
                         const std::map<std::string, std::filesystem::path>& packages, const std::string& python);

}  // namespace patrol::importer
