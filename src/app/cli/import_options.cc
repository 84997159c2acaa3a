#include <vector>

#include <fmt/format.h>

#include "app/cli/command_options.h"
#include "core/error.h"

namespace patrol::app {
namespace {

constexpr const char* kRobots = "Options of import robot";
constexpr const char* kSites = "Options of import site";

/// Throws InputError if an option of the other kind of input is given.
void refuse_options(const CLI::App& command, const std::string& kind, const char* other_group) {
  for (const CLI::Option* option : command.get_options({})) {
    if (option->get_group() == other_group && option->count() > 0)
      throw InputError(fmt::format("{}: not an option of import {}", option->get_name(), kind));
  }
}

void add_robot(CLI::App& command, ImportRobotOptions& robot) {
  command.add_option("--package", robot.packages, "Folder of a package, NAME=FOLDER (repeatable)")
      ->take_all()
      ->group(kRobots);
  command.add_option("--xacro-arg", robot.xacro_arguments, "Argument of xacro, NAME=VALUE (repeatable)")
      ->take_all()
      ->group(kRobots);
  command
      .add_option("--frame", robot.frames,
                  "Link that carries a sensor, FRAME=LINK with a frame of Patrol, such as lidar (repeatable)")
      ->take_all()
      ->group(kRobots);
  command.add_option("--base-link", robot.base_link, "Link of the chassis (default: by rule)")->group(kRobots);
  command.add_option("--forward", robot.forward, "Direction of travel in the base link (default: by rule)")
      ->check(CLI::IsMember({"x", "-x", "y", "-y"}))
      ->group(kRobots);
  command.add_option("--drive", robot.drive, "Drive (default: by rule)")
      ->check(CLI::IsMember({"differential", "ackermann", "mecanum", "legs"}))
      ->group(kRobots);
}

void add_site(CLI::App& command, ImportSiteOptions& site) {
  command.add_option("--wall-height", site.wall_height_m, "Height of the walls of a floor plan, m")
      ->check(CLI::Range(0.1, 100.0))
      ->capture_default_str()
      ->group(kSites);
  command.add_option("--scale", site.scale, "Meters per unit of the file (default: by rule)")
      ->check(CLI::PositiveNumber)
      ->group(kSites);
  command.add_option("--up", site.up, "Axis of the file that points up (default: by rule)")
      ->check(CLI::IsMember({"y", "z"}))
      ->group(kSites);
}

}  // namespace

void add_import_command(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand(
      "import", "Make a robot from a description (URDF, xacro) or a site from a file (floor plan, mesh, SDF, points)");
  command->add_option("kind", call.imported_kind, "Kind of the input: robot or site")
      ->required()
      ->check(CLI::IsMember({"robot", "site"}));
  command->add_option("file", call.import_robot.file, "File of the robot or the site, or folder of scans")->required();
  command->add_option("--out", call.import_robot.out, "Folder models/NAME or worlds/NAME, which must be empty or new")
      ->required();
  add_robot(*command, call.import_robot);
  add_site(*command, call.import_site);
  command->callback([&call, command] {
    call.chosen = [&call, command] {
      const bool is_robot = call.imported_kind == "robot";
      refuse_options(*command, call.imported_kind, is_robot ? kSites : kRobots);
      if (is_robot) return import_robot_command(call.import_robot);
      call.import_site.file = call.import_robot.file;
      call.import_site.out = call.import_robot.out;
      return import_site_command(call.import_site);
    };
  });
}

}  // namespace patrol::app
