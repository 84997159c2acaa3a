#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/robot_description.h"
#include "importer/robot_import.h"
#include "io/urdf.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer {

/// Description written to a folder and imported from there.
class Import {
 public:
  explicit Import(const std::string& text, const std::string& file = "vendor.urdf") {
    options.file = folder / file;
    options.name = "imported";
    test::write_bytes(options.file, text);
  }

  /// Imports, writes and loads the result.
  const RobotDescription& load() {
    robot = import_robot(options);
    write_robot(robot, folder / "imported");
    description = io::load_robot_description((folder / "imported/imported.urdf").string());
    return description;
  }

  const WheelGeometry& wheel(const std::string& link) const {
    const auto found = std::find_if(description.wheels.begin(), description.wheels.end(),
                                    [&](const WheelGeometry& wheel) { return wheel.link == link; });
    if (found == description.wheels.end()) throw std::runtime_error("no wheel " + link);
    return *found;
  }

  std::string assumptions() const { return report_of(robot); }

  test::TemporaryFolder folder;
  RobotImportOptions options;
  ImportedRobot robot;
  RobotDescription description;
};

}  // namespace patrol::importer
