#include "io/ros/ros_fields.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::io::ros_fields_test {
namespace {

const std::string kHead("\x00\x01\x00\x00", 4);

/// Returns why a message is refused; empty if it matches its definition.
std::string refusal_of(const std::string& type, const std::string& definition, const std::string& bytes) {
  try {
    check_ros_message(type, definition, bytes);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

// ROS 2 gives a message without fields one byte.
TEST(CheckRosMessage, AMessageWithoutFieldsHasOneByte) {
  EXPECT_EQ(refusal_of("std_msgs/msg/Empty", "", kHead + '\0'), "");
  EXPECT_EQ(refusal_of("my/msg/A", "uint8 LIMIT=3\n", kHead + '\0'), "");
  EXPECT_EQ(refusal_of("std_msgs/msg/Empty", "", kHead), "not a std_msgs/msg/Empty: the message is cut off");
  EXPECT_EQ(refusal_of("my/msg/A", "B b\nuint8 a\n===\nMSG: my/B\n", kHead + std::string("\x00\x01", 2)), "");
  EXPECT_EQ(ros_fields("my/msg/A", "B b\nuint8 a\n===\nMSG: my/B\n", kHead + std::string("\x00\x07", 2)).at(0).value,
            "7");
}

TEST(CheckRosMessage, TypesWithoutFieldsThatDoubleFortyTimesAreRefusedAtOnce) {
  for (const char* innermost : {"", "uint8[0] nothing\n"}) {
    std::string definition = "T0 a\n";
    for (int i = 0; i < 40; ++i) definition += fmt::format("===\nMSG: my/T{}\nT{} x\nT{} y\n", i, i + 1, i + 1);
    definition += fmt::format("===\nMSG: my/T40\n{}", innermost);
    EXPECT_NE(refusal_of("my/msg/Deep", definition, kHead + std::string(8, '\0')), "");
  }
}

TEST(CheckRosMessage, OnlyPaddingToFourBytesMayFollowTheLastField) {
  const std::string one = kHead + '\1';
  EXPECT_EQ(refusal_of("my/msg/A", "uint8 a\n", one), "");
  EXPECT_EQ(refusal_of("my/msg/A", "uint8 a\n", one + std::string(3, '\0')), "");
  EXPECT_EQ(refusal_of("my/msg/A", "uint8 a\n", one + std::string(4, '\0')),
            "not a my/msg/A: 4 bytes follow the last field");
  EXPECT_EQ(refusal_of("my/msg/A", "uint8 A=1\n", one + "junkjunk"), "not a my/msg/A: 8 bytes follow the last field");
}

TEST(CheckRosMessage, FieldsOfATypeWithAnEmptyDefinitionAreRefusedByTheDefinition) {
  for (const char* definition : {"", " \n\n"}) {
    EXPECT_EQ(refusal_of("my/msg/A", definition, kHead + "12345678"),
              "definition of my/msg/A is empty: must have the fields of the message");
  }
}

TEST(CheckRosMessage, TheNameOfATypeHasAPackageAndMsg) {
  for (const char* type : {"", "A", "my/A", "my/srv/A", "my/msg/", "/msg/A", "my/msg/A b", "my/msg/A/B", "1y/msg/A"})
    EXPECT_THAT(refusal_of(type, "uint8 a\n", kHead + '\1'), testing::HasSubstr("must be PACKAGE/msg/NAME")) << type;
  EXPECT_EQ(refusal_of("my_msgs2/msg/A_b3", "uint8 a\n", kHead + '\1'), "");
}

// Fast-CDR reads the header of a parameter list as that of CDR.
TEST(CheckRosMessage, OtherEncodingsThanCdrAreRefused) {
  const auto refusal = [](char first, char second) {
    return refusal_of("my/msg/A", "uint8 a\n", {first, second, 0, 0, 1});
  };
  EXPECT_EQ(refusal(0, 0), "");  // big-endian
  EXPECT_EQ(refusal(0, 1), "");
  for (const char second : {'\2', '\3', '\7', '\xff'})
    EXPECT_EQ(refusal(0, second), "not a my/msg/A: does not begin with the header of CDR");
  EXPECT_NE(refusal(1, 0), "");
}

TEST(CheckRosMessage, AWideStringIsRefusedByName) {
  EXPECT_EQ(refusal_of("my/msg/W", "wstring s\n", kHead + std::string("\x01\x00\x00\x00\x61\x00", 6)),
            "message definition: wstring is not supported: must be string");
}

}  // namespace
}  // namespace patrol::io::ros_fields_test
