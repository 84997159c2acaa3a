#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "importer/robot/robot_import.h"
#include "importer/robot/source_robot.h"
#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::broken_description_test {
namespace {

using test::TemporaryFolder, test::write_bytes;
using ::testing::HasSubstr, ::testing::MatchesRegex, ::testing::Not;

/// Message of a refused description, from the file's name on.
std::string complaint(const std::string& text, const RobotImportOptions& options = {}) {
  Import import(text, "v.urdf");
  RobotImportOptions all = options;
  all.file = import.options.file;
  all.name = "imported";
  try {
    import_robot(all);
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find('\n'), std::string::npos) << "one line";
    return what.substr(std::min(what.size(), what.find("v.urdf")));
  }
  return "";
}

/// A good description with the first `old` behind `after` replaced.
std::string changed(const std::string& old, const std::string& by, const std::string& after = "") {
  std::string text = robot(chassis() + two_wheels() + caster());
  const std::size_t at = text.find(old, text.find(after));
  if (at == std::string::npos) ADD_FAILURE() << "the description does not hold " << old;
  else text.replace(at, old.size(), by);
  return text;
}

TEST(BrokenDescription, TheUnchangedOneIsAccepted) { EXPECT_EQ(complaint(with("")), ""); }

TEST(BrokenDescription, AFileThatIsNoDescription) {
  EXPECT_THROW(import_robot({.file = "/nowhere/v.urdf"}), InputError);
  EXPECT_THROW(import_robot({.file = "/tmp"}), InputError);
  EXPECT_THAT(complaint(""), HasSubstr("v.urdf: is empty"));
  EXPECT_THAT(complaint("no XML"), HasSubstr("v.urdf"));
  const std::string zero = "v.urdf:1: not an XML file: has a byte of zero: must be text in UTF-8";
  EXPECT_EQ(complaint(std::string("\0\1\2", 3)), zero);
  EXPECT_EQ(complaint(std::string("\xff\xfe<\0r\0", 6)), zero);
  EXPECT_THAT(complaint(with("<link")), MatchesRegex("v.urdf:[0-9]+: not an XML file.*"));
  EXPECT_EQ(complaint("<robot>\n<link name=\"a\"/>"), "v.urdf:1: not an XML file: incomplete or not well-formed");
  EXPECT_THAT(complaint("<html/>"), MatchesRegex("v.urdf:1: <robot> is missing.*"));
  EXPECT_THAT(complaint(robot("")), MatchesRegex("v.urdf:2: <robot>: has no links"));
}

TEST(BrokenDescription, Duplicates) {
  EXPECT_THAT(complaint(with(link("fork"))), MatchesRegex("v.urdf:[0-9]+: fork: duplicate link: also in line [0-9]+"));
  EXPECT_THAT(complaint(with(link("x") + joint("roll", "fixed", "fork", "x", "0 0 0"))),
              MatchesRegex("v.urdf:[0-9]+: roll: duplicate joint: also in line [0-9]+"));
}

TEST(BrokenDescription, LinksThatAreNoTree) {
  EXPECT_THAT(complaint(changed("<parent link=\"fork\"/>", "<parent link=\"spoon\"/>")),
              MatchesRegex("v.urdf:[0-9]+: roll: unknown parent link: spoon"));
  EXPECT_THAT(complaint(changed("<child link=\"fork\"/>", "<child link=\"spoon\"/>")),
              MatchesRegex("v.urdf:[0-9]+: swivel: unknown child link: spoon"));
  EXPECT_THAT(complaint(with(link("alone"))),
              MatchesRegex("v.urdf:[0-9]+: alone: is not connected: .*two roots, base_link and alone"));
  EXPECT_THAT(complaint(changed("<parent link=\"base_link\"/>", "<parent link=\"small\"/>", "swivel")),
              MatchesRegex("v.urdf:[0-9]+: (fork|small): the joints form a cycle"));
  EXPECT_THAT(complaint(with(joint("twice", "fixed", "left", "small", "0 0 0"))),
              MatchesRegex("v.urdf:[0-9]+: small: child of two joints, roll and twice.*"));
  EXPECT_THAT(complaint(changed("<parent link=\"fork\"/>", "")),
              MatchesRegex("v.urdf:[0-9]+: roll: <parent link=\"...\"/> is missing"));
}

TEST(BrokenDescription, Joints) {
  EXPECT_THAT(complaint(changed("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 0 0\"/>")),
              MatchesRegex("v.urdf:[0-9]+: left_joint: axis: must not be zero"));
  EXPECT_THAT(complaint(changed("type=\"continuous\"", "type=\"ball\"")),
              MatchesRegex("v.urdf:[0-9]+: left_joint: unknown joint type \"ball\".*"));
  EXPECT_THAT(complaint(with(link("x") +
                             joint("j", "revolute", "base_link", "x", "0 0 0", R"(<limit lower="1" upper="-1"/>)"))),
              MatchesRegex("v.urdf:[0-9]+: j: limit lower = 1: must be below upper = -1"));
  EXPECT_THAT(complaint(with(link("x") + joint("j", "revolute", "base_link", "x", "0 0 0"))),
              MatchesRegex("v.urdf:[0-9]+: j: <limit> is missing.*"));
}

TEST(BrokenDescription, NegativeLimitsOfTorqueAndSpeed) {
  EXPECT_THAT(complaint(changed("effort=\"10\"", "effort=\"-20\"")),
              MatchesRegex("v.urdf:[0-9]+: left_joint: limit effort = -20: must not be negative"));
  EXPECT_THAT(complaint(changed("velocity=\"12\"", "velocity=\"-15\"")),
              MatchesRegex("v.urdf:[0-9]+: left_joint: limit velocity = -15: must not be negative"));
}

TEST(BrokenDescription, MassesAndInertias) {
  EXPECT_THAT(complaint(changed("<mass value=\"1\"/>", "<mass value=\"-1\"/>")),
              MatchesRegex("v.urdf:[0-9]+: left: mass = -1: must be positive"));
  EXPECT_THAT(complaint(changed("<mass value=\"1\"/>", "<mass value=\"0\"/>")),
              MatchesRegex("v.urdf:[0-9]+: left: mass = 0: must be positive.*"));
  EXPECT_THAT(complaint(changed("ixx=\"0.01\"", "ixx=\"0.03\"")),
              MatchesRegex("v.urdf:[0-9]+: left: invalid inertia: principal moments.*"));
  EXPECT_THAT(complaint(changed("ixx=\"0.01\"", "ixx=\"-0.01\"")),
              MatchesRegex("v.urdf:[0-9]+: left: invalid inertia: principal moments.*"));
}

TEST(BrokenDescription, AMomentOfInertiaThatIsMissing) {
  EXPECT_THAT(complaint(changed("ixx=\"0.01\"", "")), MatchesRegex("v.urdf:[0-9]+: left: <inertia>: ixx is missing"));
  EXPECT_EQ(complaint(changed("ixx=\"0.01\" ixy=\"0\" ixz=\"0\" iyy=\"0.01\" iyz=\"0\" izz=\"0.01\"", "")), "")
      << "the inertia of the shape";
}

TEST(BrokenDescription, SizesOfMoreThan20MetersAndMassesOfMoreThan1000Tons) {
  EXPECT_THAT(complaint(changed("xyz=\"0 0.25 -0.05\"", "xyz=\"0 250 -50\"")),
              MatchesRegex("v.urdf:[0-9]+: left_joint: <origin> is 255 m from the parent link: at most 20 m"));
  EXPECT_THAT(complaint(changed("<box size=\"0.6 0.4 0.2\"/>", "<box size=\"600 400 200\"/>")),
              MatchesRegex("v.urdf:[0-9]+: base_link: shape is 600 m large: at most 20 m"));
  EXPECT_THAT(complaint(changed("radius=\"0.1\"", "radius=\"100\"")),
              MatchesRegex("v.urdf:[0-9]+: left: shape is 200 m large: at most 20 m"));
  EXPECT_THAT(complaint(changed("<mass value=\"20\"/>", "<mass value=\"1e300\"/>")),
              MatchesRegex("v.urdf:[0-9]+: base_link: mass = 1e\\+300 kg: at most 1000000 kg"));
  EXPECT_THAT(complaint(changed("<origin xyz=\"0 0 0\"/><mass", "<origin xyz=\"0 0 50\"/><mass")),
              MatchesRegex("v.urdf:[0-9]+: base_link: center of mass is 50 m from the link: at most 20 m"));
  EXPECT_EQ(complaint(with(link("world") + joint("place", "fixed", "world", "base_link", "120 80 0"))), "");
}

TEST(BrokenDescription, ACenterOfMassFartherOutsideThanTheRobotIsLarge) {
  EXPECT_THAT(complaint(changed("<origin xyz=\"0 0 0\"/><mass", "<origin xyz=\"0 0 5\"/><mass")),
              MatchesRegex("v.urdf:[0-9]+: base_link: center of mass is 4.9 m outside the shapes of a robot of .*"));
}

TEST(BrokenDescription, ASteeringJointThatReachesOnlyOneSide) {
  std::string text = chassis();
  for (const auto& [side, y] : {std::pair{"l", "0.25"}, {"r", "-0.25"}}) {
    const std::string knuckle = std::string("knuckle_") + side;
    text += joint(std::string("steer_") + side, "revolute", "base_link", knuckle, fmt::format("0.4 {} -0.05", y),
                  axis("0 0 1") + R"(<limit lower="0" upper="1" effort="20" velocity="3"/>)") +
            link(knuckle, inertial(0.5)) + wheel(std::string("f") + side, knuckle, "0 0 0", 0.1, 0.05, "") +
            wheel(std::string("r") + side, "base_link", fmt::format("-0.1 {} -0.05", y), 0.1, 0.05);
  }
  EXPECT_THAT(complaint(robot(text)),
              MatchesRegex("v.urdf:[0-9]+: steer_l: steering range 0 to 1 rad: must reach at least 0.05 rad to both "
                           "sides"));
}

TEST(BrokenDescription, Numbers) {
  for (const char* bad : {"nan", "inf", "1e999", "one", "1,0", "0x"}) {
    EXPECT_THAT(complaint(changed("<mass value=\"1\"/>", fmt::format("<mass value=\"{}\"/>", bad))),
                MatchesRegex("v.urdf:[0-9]+: left: value = .*: must be finite numbers"))
        << bad;
    EXPECT_THAT(complaint(changed("iyy=\"0.01\"", fmt::format("iyy=\"{}\"", bad))),
                MatchesRegex("v.urdf:[0-9]+: left: iyy = .*: must be finite numbers"))
        << bad;
    EXPECT_THAT(complaint(changed("xyz=\"0 0.25 -0.05\"", fmt::format("xyz=\"0 {} -0.05\"", bad))),
                MatchesRegex("v.urdf:[0-9]+: left_joint: xyz = .*: must be finite numbers"))
        << bad;
  }
  EXPECT_THAT(complaint(changed("xyz=\"0 0.25 -0.05\"", "xyz=\"0 0.25\"")),
              MatchesRegex("v.urdf:[0-9]+: left_joint: xyz = .*: must be 3 numbers"));
  EXPECT_THAT(complaint(changed("radius=\"0.1\"", "radius=\"0\"")),
              MatchesRegex("v.urdf:[0-9]+: left: radius = 0: must be positive"));
}

TEST(BrokenDescription, NumbersOfALidarThatAreText) {
  const auto lidar = [](const std::string& min_angle, const std::string& range_max) {
    return with(
        fmt::format("<gazebo reference=\"base_link\">\n<sensor type=\"ray\" name=\"x\"><ray><scan><horizontal>\n"
                    "<min_angle>{}</min_angle>\n<max_angle>2</max_angle></horizontal></scan>\n"
                    "<range><max>{}</max></range></ray></sensor></gazebo>",
                    min_angle, range_max));
  };
  EXPECT_EQ(complaint(lidar("-2", " +30 ")), "");
  EXPECT_THAT(complaint(lidar("-2", "far")),
              MatchesRegex("v.urdf:[0-9]+: base_link: max = \"far\" of its sensor: must be a number"));
  EXPECT_THAT(complaint(lidar("-2", "30m")), HasSubstr("base_link: max = \"30m\" of its sensor"));
  EXPECT_THAT(complaint(lidar("nan", "30")), HasSubstr("base_link: min_angle = \"nan\" of its sensor"));
  EXPECT_THAT(complaint(lidar("", "30")), HasSubstr("base_link: min_angle = \"\" of its sensor"));
}

TEST(BrokenDescription, NamesThatAreNotUtf8) {
  EXPECT_THAT(complaint(with(link("b\xe4r") + joint("j", "fixed", "base_link", "b\xe4r", "0 0 0"))),
              MatchesRegex("v.urdf:[0-9]+: b.*r: name is not UTF-8: the file must be saved as UTF-8"));
  EXPECT_EQ(complaint(with(link("b\xc3\xa4r") + joint("j", "fixed", "base_link", "b\xc3\xa4r", "0 0 0"))), "");
  EXPECT_EQ(complaint(with("<!-- b\xe4r -->")), "");
}

TEST(BrokenDescription, Meshes) {
  const auto mesh = [](const std::string& file) {
    return with(link("x", shape("collision", "<mesh filename=\"" + file + "\"/>")) +
                joint("j", "fixed", "base_link", "x", "0 0 0"));
  };
  EXPECT_THAT(complaint(mesh("nowhere.stl")),
              MatchesRegex("v.urdf:[0-9]+: x: .*nowhere.stl: mesh file not found: .*--package.*"));
  EXPECT_THAT(complaint(mesh("v.urdf")),
              MatchesRegex("v.urdf:[0-9]+: x: .*must be an STL, OBJ, DAE, glTF or GLB file"));
  EXPECT_THAT(complaint(mesh("package://who/a.stl")), MatchesRegex("v.urdf:[0-9]+: x: unknown package \"who\".*"));
  EXPECT_THAT(complaint(with(link("x", shape("visual", "<cone/>")) + joint("j", "fixed", "base_link", "x", "0 0 0"))),
              MatchesRegex("v.urdf:[0-9]+: x: <cone>: unknown shape.*"));
  Import large(with(link("x", shape("visual", R"(<mesh filename="m.stl" scale="1 1 1"/>)")) +
                    joint("j", "fixed", "base_link", "x", "0 0 0")),
               "v.urdf");
  write_bytes(large.folder / "m.stl", stl(box_triangles({600.0, 400.0, 200.0})));
  try {
    import_robot(large.options);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(": x: mesh m is 748 m large: at most 20 m: check its scale"));
  }
  Import import(mesh("bad.stl"), "v.urdf");
  write_bytes(import.folder / "bad.stl", "solid nothing");
  try {
    import_robot(import.options);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bad.stl: mesh "));
    EXPECT_THAT(error.what(), HasSubstr(": x: "));
  }
}

TEST(BrokenDescription, ACollisionMeshWithoutASurface) {
  Import import(with(link("x", shape("collision", R"(<mesh filename="line.stl"/>)")) +
                     joint("j", "fixed", "base_link", "x", "0 0 0")),
                "v.urdf");
  const Eigen::Vector3d a(0.0, 0.0, 0.0), b(0.1, 0.0, 0.0), c(0.2, 0.0, 0.0);
  write_bytes(import.folder / "line.stl", stl({{a, b, c}}));
  try {
    import_robot(import.options);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(": x: collision mesh line has no surface"));
  }
}

TEST(BrokenDescription, AnEmptyNameOfTheOutputFolder) {
  Import import(with(""));
  try {
    write_robot(import_robot(import.options), "");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("output folder: is empty"));
  }
}

TEST(BrokenDescription, Wheels) {
  EXPECT_THAT(complaint(changed("xyz=\"0 0.25 -0.05\"", "xyz=\"0 0.25 -0.02\"")),
              MatchesRegex("v.urdf:[0-9]+: left: is 0.030 m above the lowest wheel: all wheels must touch one plane"));
  EXPECT_THAT(complaint(robot(chassis())), HasSubstr("v.urdf: no wheels found"));
  EXPECT_THAT(complaint(robot(chassis() + wheel("fl", "base_link", "0.2 0.25 -0.05", 0.1, 0.04) +
                              wheel("rl", "base_link", "-0.2 0.25 -0.05", 0.1, 0.04) +
                              wheel("fr", "base_link", "0.2 -0.25 -0.05", 0.1, 0.04, "") +
                              wheel("rr", "base_link", "-0.2 -0.25 -0.05", 0.1, 0.04, ""))),
              MatchesRegex("v.urdf:[0-9]+: [fr]l_joint: driven wheels on one side only.*"));
  std::string rollers;
  for (int i = 0; i < 6; ++i)
    rollers +=
        joint(fmt::format("r{}", i), "continuous", "left", fmt::format("roller{}", i), "0 0 0.1", axis("1 1 0")) +
        link(fmt::format("roller{}", i), inertial(0.01));
  EXPECT_THAT(complaint(with(rollers)),
              MatchesRegex("v.urdf:[0-9]+: left: has 6 rollers on joints: roller roller0 has no shape"));
  EXPECT_THAT(complaint(robot(chassis() +
                              joint("pivot", "revolute", "base_link", "axle", "0.2 0 -0.05",
                                    axis("0 0 1") + R"(<limit lower="-1" upper="1"/>)") +
                              link("axle", inertial(1.0)) + wheel("fl", "axle", "0 0.25 0", 0.1, 0.04) +
                              wheel("fr", "axle", "0 -0.25 0", 0.1, 0.04) + two_wheels())),
              MatchesRegex("v.urdf:[0-9]+: pivot: steers a whole axle.*"));
  EXPECT_THAT(complaint(changed("<cylinder radius=\"0.1\" length=\"0.04\"/>", "<box size=\"0.2 0.2 0.04\"/>")),
              HasSubstr("v.urdf:"));
}

TEST(BrokenDescription, Mimics) {
  const auto with_mimic = [](const std::string& mimic) {
    return complaint(changed("<limit effort=\"10\" velocity=\"12\"/>", mimic));
  };
  EXPECT_EQ(with_mimic("<mimic joint=\"right_joint\" multiplier=\"-1\" offset=\"0.5\"/>"), "");
  EXPECT_EQ(with_mimic("<mimic joint=\"ghost\"/>"), "v.urdf:4: left_joint: <mimic>: unknown joint: ghost");
  EXPECT_EQ(with_mimic("<mimic/>"), "v.urdf:4: left_joint: <mimic>: joint is missing");
  EXPECT_EQ(with_mimic("<mimic joint=\"left_joint\"/>"), "v.urdf:4: left_joint: <mimic>: the joint follows itself");
  EXPECT_EQ(with_mimic("<mimic joint=\"right_joint\" multiplier=\"x\"/>"),
            "v.urdf:4: left_joint: multiplier = \"x\": must be finite numbers");
  std::string cycle = changed("<limit effort=\"10\" velocity=\"12\"/>", "<mimic joint=\"right_joint\"/>");
  cycle.replace(cycle.find("<limit"), cycle.find("/>", cycle.find("<limit")) + 2 - cycle.find("<limit"),
                "<mimic joint=\"left_joint\"/>");
  EXPECT_EQ(complaint(cycle), "v.urdf:4: left_joint: <mimic>: the joint follows itself");
}

TEST(BrokenDescription, ADrivenLinkThatIsNoWheelIsNamedWithItsReason) {
  const std::string round = "<cylinder radius=\"0.1\" length=\"0.04\"/>";
  EXPECT_THAT(complaint(changed(round, "<box size=\"0.2 0.2 0.04\"/>")),
              MatchesRegex("v.urdf:[0-9]+: left: is no wheel: is not round about the axis of joint left_joint; without "
                           "it, driven wheels on one side only: both sides must be driven"));
  EXPECT_THAT(complaint(changed("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 0 1\"/>")),
              MatchesRegex("v.urdf:[0-9]+: left: is no wheel: the axis of joint left_joint is not horizontal; .*"));
  EXPECT_THAT(complaint(changed(round, "<cylinder radius=\"0.04\" length=\"0.04\"/>")),
              MatchesRegex("v.urdf:[0-9]+: left: is no wheel: is round, but 0.060 m above the ground of the lowest "
                           "wheel; .*"));
  std::string boxes = changed(round, "<box size=\"0.2 0.2 0.04\"/>");
  boxes.replace(boxes.find(round), round.size(), "<box size=\"0.2 0.2 0.04\"/>");
  EXPECT_THAT(complaint(boxes), MatchesRegex("v.urdf:[0-9]+: left: is no wheel: .*; without it, all wheels are "
                                             "casters: at least two wheels must not swivel"));
}

TEST(BrokenDescription, ARobotWhoseWheelsAreAllSteeredByMotorsWithoutEnd) {
  const auto modules = [](const std::string& front_motor, const std::string& rear_motor) {
    std::string text = chassis();
    for (const auto& [name, xyz] : {std::pair{"fl", "0.2 0.25 -0.05"},
                                    {"fr", "0.2 -0.25 -0.05"},
                                    {"rl", "-0.2 0.25 -0.05"},
                                    {"rr", "-0.2 -0.25 -0.05"}}) {
      const std::string fork = std::string(name) + "_fork", &motor = name[0] == 'f' ? front_motor : rear_motor;
      const char* type = motor.find("lower") == std::string::npos ? "continuous" : "revolute";
      text += joint(std::string(name) + "_steer", type, "base_link", fork, xyz, axis("0 0 1") + motor) +
              link(fork, inertial(0.5)) + wheel(name, fork, "0 0 0", 0.1, 0.05);
    }
    return robot(text);
  };
  const std::string motor = R"(<limit effort="30" velocity="3"/>)";
  EXPECT_EQ(complaint(modules(motor, motor)),
            "v.urdf:4: fl_steer: all 4 wheels are steered: not supported: fix the steering joints of one axle");
  EXPECT_EQ(complaint(modules("", "")),
            "v.urdf:4: fl_steer: all wheels are casters: at least two wheels must not swivel");
  EXPECT_THAT(complaint(modules(R"(<limit lower="-0.5" upper="0.5" effort="30" velocity="3"/>)", "")),
              MatchesRegex("v.urdf:[0-9]+: fl_joint: all wheels but casters are steered: not supported: both sides "
                           "must have one that is not"));
}

TEST(BrokenDescription, ATrailerOnAnEndlessHitch) {
  const auto behind = [](double track_m) {
    const std::string none;
    return robot(chassis() + two_wheels() +
                 joint("hitch", "continuous", "base_link", "trailer", "-0.3 0 0", axis("0 0 1")) +
                 link("trailer", inertial(5.0)) +
                 wheel("tl", "trailer", fmt::format("-0.3 {} -0.05", 0.5 * track_m), 0.1, 0.04, none) +
                 wheel("tr", "trailer", fmt::format("-0.3 {} -0.05", -0.5 * track_m), 0.1, 0.04, none));
  };
  EXPECT_THAT(complaint(behind(0.5)), MatchesRegex("v.urdf:[0-9]+: hitch: swivels with a whole axle: trailers, .*"));
  EXPECT_EQ(complaint(behind(0.1)), "") << "two wheels of a caster";
}

TEST(BrokenDescription, ARobotOnWheelsWhoseYAxisIsUp) {
  std::string wheels;
  for (const char* xyz : {"0.25 -0.05 0.2", "-0.25 -0.05 0.2", "0.25 -0.05 -0.2", "-0.25 -0.05 -0.2"}) {
    const std::string name = "w" + std::to_string(wheels.size());
    wheels += joint(name + "_joint", "continuous", "base_link", name, xyz, axis("1 0 0") + kMotor) +
              link(name, inertial(1.0) + shape("collision", cylinder(0.1, 0.05), "0 0 0", "0 1.5707963267948966 0"));
  }
  EXPECT_THAT(complaint(robot(chassis() + wheels)),
              MatchesRegex("v.urdf:[0-9]+: w0_joint: the wheels touch one plane, but it is upright: z of base_link "
                           "must be up: .*"));
}

TEST(BrokenDescription, ADrivenWheelInTheMiddle) {
  EXPECT_THAT(complaint(robot(chassis() + wheel("axle", "base_link", "0.2 0 -0.05", 0.1, 0.5) +
                              wheel("l", "base_link", "-0.2 0.25 -0.05", 0.1, 0.04, "") +
                              wheel("r", "base_link", "-0.2 -0.25 -0.05", 0.1, 0.04, ""))),
              MatchesRegex("v.urdf:[0-9]+: axle_joint: the driven wheel is in the middle: not supported: .*"));
}

TEST(BrokenDescription, AFolderOfAPackageThatDoesNotExist) {
  Import import(with(""));
  import.options.packages["who"] = "/nowhere";
  try {
    import_robot(import.options);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "--package who=/nowhere: folder not found");
  }
}

TEST(BrokenDescription, Options) {
  EXPECT_THAT(complaint(with(""), {.file = "", .base_link = "torso"}),
              HasSubstr("v.urdf: base link torso: unknown link"));
  EXPECT_THAT(complaint(with(""), {.file = "", .base_link = "left"}),
              MatchesRegex("v.urdf:[0-9]+: left: moves against the body.*"));
  EXPECT_THAT(complaint(with(""), {.file = "", .frames = {{"lidar", "mast"}}}),
              HasSubstr("v.urdf: frame lidar: unknown link mast"));
  EXPECT_THAT(complaint(with(""), {.file = "", .frames = {{"sonar", "fork"}}}),
              HasSubstr("v.urdf: frame sonar: unknown sensor frame"));
  EXPECT_THAT(complaint(with(""), {.file = "", .drive = "hover"}), HasSubstr("v.urdf: drive hover: must be"));
  EXPECT_THAT(complaint(with(""), {.file = "", .drive = "ackermann"}),
              HasSubstr("v.urdf: drive ackermann: no wheel is below"));
  EXPECT_THAT(complaint(with(""), {.file = "", .forward = "up"}), HasSubstr("v.urdf: forward up: must be"));
}

}  // namespace
}  // namespace patrol::importer::broken_description_test
