#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "importer/robot/source_robot.h"

namespace patrol::importer {

/// Options of `patrol import robot`.
struct RobotImportOptions {
  std::filesystem::path file;  ///< .urdf or .xacro
  std::string name = {};       ///< name of the robot, its folder and files; empty: the name in the file
  std::map<std::string, std::filesystem::path> packages = {};  ///< folders of package:// and $(find ...)
  std::map<std::string, std::string> xacro_arguments = {};
  /// Python interpreter with the package xacro; the environment variable PATROL_PYTHON overrides it.
  std::string python = "python3";
  std::string base_link = {};  ///< link of the file; empty: by rule
  std::string forward = {};    ///< direction of travel in the base link: x, -x, y, -y; empty: by rule
  std::map<std::string, std::string> frames = {};  ///< sensor frame of Patrol to link of the file
  std::set<std::string> casters = {};              ///< links of the file that slide although they look like wheels
  std::string drive = {};                          ///< differential, ackermann, mecanum or legs; empty: by rule
};

/// Robot in Patrol's conventions, not yet written.
struct ImportedRobot {
  std::string name;
  std::string source;                                       ///< name of the file that it was read from
  std::string file;                                         ///< path of this file, for messages
  std::string urdf;                                         ///< text of NAME.urdf
  std::string settings;                                     ///< text of NAME.yaml
  std::vector<std::pair<std::string, std::string>> meshes;  ///< file name below meshes/, and OBJ text
  std::vector<Assumption> assumptions;
  std::map<std::string, std::string> sources = {};  ///< link of `urdf` to "FILE:LINE: link", for messages
};

/// Reads a robot description and normalizes it (importer/README.md). Throws InputError with one line:
/// "file:line: element: what".
ImportedRobot import_robot(const RobotImportOptions& options);

/// Writes NAME.urdf, NAME.yaml, README.md and meshes/ into a folder: first into a folder beside it, which is checked by
/// the reader of URDF files (io/urdf.h) and then renamed. Throws InputError if the folder exists and is not empty, or
/// cannot be written; nothing is left behind then.
void write_robot(const ImportedRobot& robot, const std::filesystem::path& folder);

/// Returns a Markdown page with the table of assumptions.
std::string report_of(const ImportedRobot& robot);

}  // namespace patrol::importer
