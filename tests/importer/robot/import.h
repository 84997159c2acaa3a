#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/robot_description.h"
#include "importer/robot/robot_import.h"
#include "io/urdf.h"
#include "tests/support/pose_near.h"
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

/// Expects an exact wheel.
inline void expect_wheel(const Import& import, const std::string& link, const Eigen::Vector3d& center, double radius_m,
                         double width_m, double tolerance = 1e-6) {
  const WheelGeometry& wheel = import.wheel(link);
  EXPECT_THAT(wheel.center_in_body, test::VectorNear(center, tolerance)) << link;
  EXPECT_NEAR(wheel.radius_m, radius_m, tolerance) << link;
  EXPECT_NEAR(wheel.width_m, width_m, tolerance) << link;
}

/// Imports; returns the message of a refused description, from the file's name on.
inline std::string complaint(Import& import) {
  try {
    import.load();
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find('\n'), std::string::npos) << "one line";
    return what.substr(std::min(what.size(), what.rfind("vendor.urdf")));
  }
  return "";
}

}  // namespace patrol::importer
