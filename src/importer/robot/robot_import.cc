#include "importer/robot/robot_import.h"

#include <cstddef>
#include <regex>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "importer/output_folder.h"
#include "importer/packages.h"
#include "importer/robot/fixed_wheels.h"
#include "importer/robot/normalize.h"
#include "importer/robot/robot_settings.h"
#include "importer/xacro.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"
#include "io/urdf.h"

namespace patrol::importer {

ImportedRobot import_robot(const RobotImportOptions& options) {
  const std::string file = options.file.string();
  const Packages packages(options.packages, options.file);
  const ExpandedFile loaded = load_expanded(options.file, {options.xacro_arguments, options.packages, options.python});
  SourceRobot source = read_source_robot(file, loaded.text, packages);
  source.assumptions.insert(source.assumptions.begin(), loaded.rows.begin(), loaded.rows.end());
  release_fixed_wheels(source);
  const NormalizedRobot robot = normalize(source, {.name = options.name,
                                                   .base_link = options.base_link,
                                                   .forward = options.forward,
                                                   .frames = options.frames,
                                                   .casters = options.casters,
                                                   .drive = options.drive});
  require_folder_name(robot.name, file, "robot");
  std::map<std::string, std::string> sources;
  for (const auto& [link, name] : robot.source_links)
    sources[link] = fmt::format("{}: {}", source.location(source.link(name).line), io::on_one_line(name));
  const std::string origin = options.file.filename().string();
  return {
      .name = robot.name,
      .source = origin,
      .file = file,
      .urdf = to_urdf(robot, fmt::format("{}, made by patrol import robot from {}; README.md lists the assumptions.",
                                         io::on_one_line(robot.name), io::on_one_line(origin))),
      .settings = settings_of(robot, fmt::format("Settings of {} that differ from the defaults, made by patrol import "
                                                 "robot from {}.",
                                                 io::on_one_line(robot.name), io::on_one_line(origin))),
      .meshes = robot.meshes,
      .assumptions = robot.assumptions,
      .sources = std::move(sources)};
}

void write_robot(const ImportedRobot& robot, const std::filesystem::path& folder) {
  require_folder_name(robot.name, robot.file, "robot");
  OutputFolder output(folder);
  io::save_text(output.staging() / (robot.name + ".urdf"), robot.urdf);
  io::save_text(output.staging() / (robot.name + ".yaml"), robot.settings);
  io::save_text(output.staging() / "README.md", report_of(robot));
  if (!robot.meshes.empty()) std::filesystem::create_directory(output.staging() / "meshes");
  for (const auto& [name, text] : robot.meshes) io::save_text(output.staging() / "meshes" / name, text);
  const std::string urdf = (output.staging() / (robot.name + ".urdf")).string();
  try {
    io::load_robot_description(urdf);
  } catch (const InputError& refused) {
    std::string message = refused.what();
    if (message.starts_with(urdf))
      message = std::regex_replace(message.substr(urdf.size()), std::regex("^:([0-9]+:)? *"), "");
    const std::size_t end = message.find(": ");
    const auto named = end == std::string::npos ? robot.sources.end() : robot.sources.find(message.substr(0, end));
    if (named == robot.sources.end())
      throw InputError(fmt::format("{}: the robot cannot be simulated: {}", robot.file, message));
    throw InputError(fmt::format("{}: the robot cannot be simulated: {}", named->second, message.substr(end + 2)));
  }
  output.publish();
}

std::string report_of(const ImportedRobot& robot) {
  return fmt::format("# {}\n\nMade by `patrol import robot` from `{}`.\n\n## Assumptions\n\n",
                     io::on_one_line(robot.name), io::on_one_line(robot.source)) +
         to_markdown(robot.assumptions, "None: the description determines the robot.\n");
}

}  // namespace patrol::importer
