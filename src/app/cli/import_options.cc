#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/cli/command_options.h"
#include "app/cli/number_checks.h"
#include "core/error.h"

namespace patrol::app {
namespace {

constexpr const char* kRobots = "Options of import robot";
constexpr const char* kSites = "Options of import site";
constexpr const char* kBoth = "Options of both";

/// Throws InputError if an option of the other kind of input is given.
void refuse_options(const CLI::App& command, const std::string& kind, const char* other_group) {
  for (const CLI::Option* option : command.get_options({})) {
    if (option->get_group() == other_group && option->count() > 0)
      throw InputError(fmt::format("{}: not an option of import {}", option->get_name(), kind));
  }
}

/// Names of the options on the command line.
std::vector<std::string> given_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options({})) {
    if (option->count() > 0) names.push_back(option->get_name());
  }
  return names;
}

void add_robot(CLI::App& command, ImportRobotOptions& robot) {
  command.add_option("--package", robot.packages, "Folder of a package or of a model of SDF, NAME=FOLDER (repeatable)")
      ->take_all()
      ->group(kBoth);
  command.add_option("--xacro-arg", robot.xacro_arguments, "Argument of xacro, NAME=VALUE (repeatable)")
      ->take_all()
      ->group(kBoth);
  command
      .add_option("--frame", robot.frames,
                  "Link that carries a sensor, FRAME=LINK with a frame of Patrol, such as lidar (repeatable)")
      ->take_all()
      ->group(kRobots);
  command.add_option("--base-link", robot.base_link, "Link of the chassis (default: by rule)")->group(kRobots);
  command
      .add_option("--caster", robot.casters,
                  "Link that slides on the ground although it looks like a wheel (repeatable)")
      ->take_all()
      ->group(kRobots);
  command.add_option("--forward", robot.forward, "Direction of travel in the base link (default: by rule)")
      ->check(CLI::IsMember({"x", "-x", "y", "-y"}))
      ->group(kRobots);
  command.add_option("--drive", robot.drive, "Drive (default: by rule)")
      ->check(CLI::IsMember({"differential", "ackermann", "mecanum", "legs"}))
      ->group(kRobots);
}

void add_site(CLI::App& command, ImportSiteOptions& site) {
  command.add_option("--wall-height", site.wall_height_m, "Height of the walls of a floor plan or a log, m")
      ->check(CLI::Range(0.1, 100.0))
      ->capture_default_str()
      ->group(kSites);
  command.add_option("--scale", site.scale, "Meters per unit of a mesh or of points (default: by rule)")
      ->check(above_zero())
      ->group(kSites);
  command.add_option("--up", site.up, "Axis of a mesh or of points that points up (default: by rule)")
      ->check(CLI::IsMember({"y", "z"}))
      ->group(kSites);
  command.add_option("--stations", site.stations, "Stations of the mission: CSV with the columns name, x, y")
      ->group(kSites);
  command.add_option("--random-stations", site.random_stations, "Number of random stations of the mission")
      ->check(CLI::Range(1, 1000))
      ->group(kSites);
  command.add_option("--seed", site.seed, "Random seed of the stations")->capture_default_str()->group(kSites);
  command
      .add_option("--start", site.start,
                  "Start of the mission, X,Y or X,Y,DEG, and point of a mesh's ground (default: by rule)")
      ->group(kSites);
  command.add_option("--without", site.without, "Model of an SDF world to leave out, such as its robot (repeatable)")
      ->take_all()
      ->group(kSites);
  command.add_option("--robot", site.robot, "Robot of the scenario")->capture_default_str()->group(kSites);
  command.add_option("--contact-cell", site.contact_cell_m, "Cell of the contact geometry of a mesh or of SDF, m")
      ->check(CLI::Range(0.02, 1.0))
      ->capture_default_str()
      ->group(kSites);
}

}  // namespace

void add_import_command(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand(
      "import", "Make a robot from a description (URDF, xacro) or a site from a file (floor plan, mesh, SDF, points)");
  command->add_option("kind", call.imported_kind, "Kind of the input: robot or site")
      ->required()
      ->check(CLI::IsMember({"robot", "site"}));
  command
      ->add_option("file", call.import_robot.file, "File of the robot or the site, folder of scans, or run directory")
      ->required();
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
      call.import_site.packages = call.import_robot.packages;
      call.import_site.xacro_arguments = call.import_robot.xacro_arguments;
      call.import_site.given = given_options(*command);
      return import_site_command(call.import_site);
    };
  });
}

void add_generate_command(CLI::App& app, Call& call) {
  GenerateOptions& generate = call.generate;
  CLI::App* command = app.add_subcommand("generate", "Generate obstacle courses with start, goal and optimal time");
  command->add_option("kind", call.generated_kind, "Kind of the site: courses")
      ->required()
      ->check(CLI::IsMember({"courses"}));
  command->add_option("--number", generate.number, "Number of the first course")->capture_default_str();
  command->add_option("--count", generate.count, "Number of courses")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--robot", generate.robot, "Robot, whose size and speed the courses fit")->capture_default_str();
  command->add_option("--out", generate.out, "Folder that receives a folder course_NUMBER for each course")
      ->capture_default_str();
  command->callback([&] { call.chosen = [&] { return generate_command(call.generate); }; });
}

void add_site_command(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("site", "Report the ground, walls and obstacles of a site");
  command->add_option("world", call.site.world, "Name of the site, a folder of worlds")->required();
  add_json(*command, call.site.form);
  command->callback([&] { call.chosen = [&] { return site_command(call.site); }; });
}

}  // namespace patrol::app
