#include "importer/robot_import.h"

#include <unistd.h>

#include <system_error>

#include <fmt/format.h>

#include "core/error.h"
#include "importer/normalize.h"
#include "importer/packages.h"
#include "importer/robot_settings.h"
#include "importer/xacro.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"
#include "io/urdf.h"

namespace patrol::importer {
namespace {

/// Returns text for a cell of a Markdown table.
std::string table_cell(const std::string& text) {
  std::string cell;
  for (const char c : io::on_one_line(text)) {
    if (c == '|') cell += '\\';
    if (c == '<') cell += "&lt;";
    else cell += c;
  }
  return cell;
}

/// Folder that is removed with its content unless it is kept.
class StagingFolder {
 public:
  explicit StagingFolder(std::filesystem::path path) : path_(std::move(path)) {}
  ~StagingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  StagingFolder(const StagingFolder&) = delete;
  StagingFolder& operator=(const StagingFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void check_name(const std::string& name, const std::string& file) {
  const bool is_path = name.find('/') != std::string::npos || name == "." || name == "..";
  if (name.empty() || is_path || io::has_control_characters(name)) {
    throw InputError(
        fmt::format("{}: name of the robot = \"{}\": must be the name of a folder", file, io::on_one_line(name)));
  }
}

}  // namespace

ImportedRobot import_robot(const RobotImportOptions& options) {
  const std::string file = options.file.string();
  std::string text = io::load_text(options.file), label = file;
  if (is_xacro(options.file)) {
    text = expand_xacro(options.file, options.xacro_arguments, options.packages);
    label += " (expanded)";
  }
  const Packages packages(options.packages, options.file);
  const SourceRobot source = read_source_robot(label, text, packages);
  const NormalizedRobot robot = normalize(source, {.name = options.name,
                                                   .base_link = options.base_link,
                                                   .forward = options.forward,
                                                   .frames = options.frames,
                                                   .drive = options.drive});
  check_name(robot.name, file);
  const std::string origin = options.file.filename().string();
  return {
      .name = robot.name,
      .source = origin,
      .urdf = to_urdf(robot, fmt::format("{}, made by patrol import robot from {}; README.md lists the assumptions.",
                                         io::on_one_line(robot.name), io::on_one_line(origin))),
      .settings = settings_of(robot, fmt::format("Settings of {} that differ from the defaults, made by patrol import "
                                                 "robot from {}.",
                                                 io::on_one_line(robot.name), io::on_one_line(origin))),
      .meshes = robot.meshes,
      .assumptions = robot.assumptions};
}

void write_robot(const ImportedRobot& robot, const std::filesystem::path& folder) {
  check_name(robot.name, robot.source);
  const std::filesystem::path target = std::filesystem::absolute(folder).lexically_normal();
  const std::filesystem::path path = target.has_filename() ? target : target.parent_path();
  std::error_code error;
  if (std::filesystem::exists(path, error) &&
      (!std::filesystem::is_directory(path, error) || !std::filesystem::is_empty(path, error)))
    throw InputError(path.string() + ": exists and is not an empty folder");
  const StagingFolder staging(fmt::format("{}.{}.part", path.string(), ::getpid()));
  std::filesystem::remove_all(staging.path(), error);
  std::filesystem::create_directories(staging.path() / "meshes", error);
  if (error) throw InputError(fmt::format("{}: cannot be written: {}", path.string(), error.message()));
  io::save_text(staging.path() / (robot.name + ".urdf"), robot.urdf);
  io::save_text(staging.path() / (robot.name + ".yaml"), robot.settings);
  io::save_text(staging.path() / "README.md", report_of(robot));
  for (const auto& [name, text] : robot.meshes) io::save_text(staging.path() / "meshes" / name, text);
  if (robot.meshes.empty()) std::filesystem::remove(staging.path() / "meshes", error);
  const std::string urdf = (staging.path() / (robot.name + ".urdf")).string();
  try {
    io::load_robot_description(urdf);
  } catch (const InputError& refused) {
    const std::string message = refused.what();
    throw InputError(
        fmt::format("{}: the normalized description is refused: {}", robot.source,
                    message.starts_with(urdf) ? robot.name + ".urdf" + message.substr(urdf.size()) : message));
  }
  std::filesystem::remove(path, error);  // an empty folder
  std::filesystem::rename(staging.path(), path, error);
  if (error) throw InputError(fmt::format("{}: cannot be written: {}", path.string(), error.message()));
}

std::string report_of(const ImportedRobot& robot) {
  std::string text = fmt::format("# {}\n\nMade by `patrol import robot` from `{}`.\n\n## Assumptions\n\n",
                                 io::on_one_line(robot.name), io::on_one_line(robot.source));
  if (robot.assumptions.empty()) return text + "None: the description determines the robot.\n";
  text += "| subject | assumption | overridden by |\n| --- | --- | --- |\n";
  for (const Assumption& row : robot.assumptions) {
    text +=
        fmt::format("| {} | {} | {} |\n", table_cell(row.subject), table_cell(row.text), table_cell(row.override_with));
  }
  return text;
}

}  // namespace patrol::importer
