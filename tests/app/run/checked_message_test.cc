#include "app/run/checked_message.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/logs/topics.h"
#include "io/ros/ros_messages.h"
#include "link/link_error.h"
#include "tests/io/sample_messages.h"

namespace patrol::app::checked_message_test {
namespace {

using namespace std::chrono_literals;

template <typename Message>
link::PublishedMessage published(const Message& message) {
  return {.topic = io::kTopic<Message>, .type = io::kRosType<Message>, .definition = {}, .cdr = io::encode(message)};
}

/// Returns why a message of a stack is refused; empty if it is accepted.
std::string refusal_of(link::PublishedMessage message) {
  try {
    checked_message(std::move(message));
    return {};
  } catch (const link::LinkError& error) {
    return error.what();
  }
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(CheckedMessage, AcceptsAMessageOfEachOfThe18TypesOfAStack) {
  int num_types = 0;
  std::apply(
      [&](const auto&... message) {
        const auto check = [&]<typename Message>(const Message& one) {
          if constexpr (std::is_constructible_v<stack::StackMessage, Message>) {
            if (!io::is_stack_output(io::kTopic<Message>)) return;
            EXPECT_EQ(refusal_of(published(one)), "");
            ++num_types;
          }
        };
        (check(message), ...);
      },
      test::all_samples());
  EXPECT_EQ(num_types, 17);  // all_samples has no TrajectoryEstimate
  EXPECT_EQ(refusal_of(published(TrajectoryEstimate{.stamp = test::kSampleStamp,
                                                    .T_map_body = {{test::kSampleStamp, test::sample_pose()}}})),
            "");
}

TEST(CheckedMessage, RefusesNaNInAPlanAndInAConfidence) {
  Path plan = test::sample_path();
  plan.T_map_body[0].x = kNan;
  EXPECT_EQ(refusal_of(published(plan)), "message on /plan: contains a number that is not finite");
  LocalizationConfidence confidence = test::sample_trust();
  confidence.confidence = kNan;
  EXPECT_EQ(refusal_of(published(confidence)),
            "message on /localization_confidence: contains a number that is not finite");
}

TEST(CheckedMessage, RefusesTextThatIsNotUtf8ByItsName) {
  const auto event = [](const std::string& kind, const std::string& subject, const std::string& text) {
    Event one{.subject = subject, .text = text};
    set_kind(one, kind);
    return refusal_of(published(one));
  };
  EXPECT_EQ(event("my kind", "B\xc3\xa4r", "a text"), "");
  EXPECT_EQ(event("k\xff", "", ""), "message on /events: kind is not UTF-8");
  EXPECT_EQ(event("station_reached", "caf\xe9", ""), "message on /events: subject is not UTF-8");
  EXPECT_EQ(event("station_reached", "", "\xc0\x80"), "message on /events: text is not UTF-8");
  LiningResult lining;
  lining.lines = {{.ring = 1, .name = "9-\xff"}};
  EXPECT_EQ(refusal_of(published(lining)), "message on /inspection/lining: name of a line is not UTF-8");
  lining.station = "\xff";
  EXPECT_EQ(refusal_of(published(lining)), "message on /inspection/lining: station is not UTF-8");
  WaterResult water;
  water.station = "\xff";
  EXPECT_EQ(refusal_of(published(water)), "message on /inspection/water: station is not UTF-8");
  CalibrationEstimate calibration;
  calibration.values = {{.name = "\xff"}};
  EXPECT_EQ(refusal_of(published(calibration)), "message on /calibration: name of a value is not UTF-8");
}

TEST(CheckedMessage, RefusesAMapOfResolution0ByItsResolution) {
  EXPECT_EQ(refusal_of(published(MapUpdate{
                .stamp = {}, .map = OccupancyGrid({.resolution_m = 0.0, .width = 1, .height = 1}, kUnknown)})),
            "message on /map: resolution must be at least 0.0001 m");
}

TEST(CheckedMessage, RefusesPositionsFartherThan10000KilometersOnEveryTopicWithAPosition) {
  const auto refusal = [](double x_m) {
    const stack::StackMessage all[] = {
        OdometryEstimate{.T_odom_body = to_pose3({x_m, 0.0, 0.0}), .twist = {}},
        PoseEstimate{.stamp = {}, .T_map_body = {0.0, x_m, 0.0}},
        SiteRegistration{.T_site_map = {x_m, 0.0, 0.0}},
        Path{.stamp = {}, .T_map_body = {{}, {x_m, 0.0, 0.0}}},
        TrajectoryEstimate{.stamp = {}, .T_map_body = {{{}, to_pose3({x_m, 0.0, 0.0})}}},
        Event{.T_map_body = {x_m, 0.0, 0.0}},
        Event{.p_map_target = {0.0, x_m}},
    };
    std::set<std::string> refusals;
    for (const stack::StackMessage& one : all) {
      const link::PublishedMessage message = std::visit([](const auto& content) { return published(content); }, one);
      const std::string text = refusal_of(message);
      refusals.insert(text.substr(text.find(": ") + 1));
    }
    return refusals;
  };
  EXPECT_EQ(refusal(1e7), std::set<std::string>{""});
  EXPECT_EQ(refusal(-1e7), std::set<std::string>{""});
  for (const auto& [x_m, number] : {std::pair{1e300, "1e+300"}, std::pair{-1e9, "1e+09"}}) {
    EXPECT_EQ(refusal(x_m), std::set<std::string>{fmt::format(" contains a position with a coordinate of {} m: must be "
                                                              "within 10000000 m of the origin of its frame",
                                                              number)});
  }
}

TEST(CheckedMessage, RefusesCellsOfAMapOutsideOfMinus1To100) {
  const auto refusal = [](std::int8_t cell) {
    OccupancyGrid map({.resolution_m = 0.05, .width = 2, .height = 2}, kUnknown);
    map.values().back() = cell;
    return refusal_of(published(MapUpdate{.stamp = {}, .map = map}));
  };
  EXPECT_EQ(refusal(-1) + refusal(0) + refusal(100), "");
  EXPECT_EQ(refusal(101), "message on /map: a cell of the map is 101: must be in [-1, 100]");
  EXPECT_EQ(refusal(-2), "message on /map: a cell of the map is -2: must be in [-1, 100]");
}

TEST(CheckedMessage, RefusesAResolutionBelowATenthOfAMillimeter) {
  const auto refusal = [](double resolution_m) {
    return refusal_of(published(MapUpdate{
        .stamp = {}, .map = OccupancyGrid({.resolution_m = resolution_m, .width = 1, .height = 1}, kUnknown)}));
  };
  EXPECT_EQ(refusal(0.00009), "message on /map: resolution must be at least 0.0001 m");
  EXPECT_EQ(refusal(0.0001), "");
}

TEST(CheckedMessage, RefusesQuaternionsWhoseNormIsNot1OnEveryTopicWithAPose) {
  const auto with_w = [](link::PublishedMessage message, double w) {
    const double one = 1.0;
    const std::size_t at = message.cdr.find(std::string(reinterpret_cast<const char*>(&one), sizeof one));
    message.cdr.replace(at, sizeof w, reinterpret_cast<const char*>(&w), sizeof w);
    return message;
  };
  const stack::StackMessage all[] = {
      OdometryEstimate{},
      PoseEstimate{},
      UwbPoseEstimate{},
      SiteRegistration{},
      ParticleSet{.stamp = {}, .T_map_body = {{}}, .weights = {0.5}},
      Path{.stamp = {}, .T_map_body = {{}}},
      TrajectoryEstimate{.stamp = {}, .T_map_body = {{}}},
      Event{},
  };
  for (const stack::StackMessage& one : all) {
    const link::PublishedMessage message = std::visit([](const auto& content) { return published(content); }, one);
    EXPECT_EQ(refusal_of(with_w(message, 1.0)), "") << message.topic;
    EXPECT_EQ(refusal_of(with_w(message, -1.0)), "") << message.topic;
    for (const double w : {0.0, 5.0, 0.99}) {
      EXPECT_EQ(refusal_of(with_w(message, w)),
                "message on " + message.topic + ": contains a quaternion whose norm is not 1");
    }
  }
}

constexpr StampRange kAtTwoSeconds{.from = -1s, .to = 3s};

std::string refusal_at_two_seconds(const auto& message) {
  try {
    checked_message(published(message), kAtTwoSeconds);
    return {};
  } catch (const link::LinkError& error) {
    return error.what();
  }
}

TEST(CheckedMessage, RefusesStampsOutsideOfTheTurnByTopicStampAndRange) {
  EXPECT_EQ(refusal_at_two_seconds(PoseEstimate{.stamp = 3s, .T_map_body = {}}), "");
  EXPECT_EQ(refusal_at_two_seconds(PoseEstimate{.stamp = 0s, .T_map_body = {}}), "");
  EXPECT_EQ(refusal_at_two_seconds(UwbPoseEstimate{PoseEstimate{.stamp = 1'796'000'000s, .T_map_body = {}}}),
            "message on /uwb_odometry/pose: stamp is 1796000000.000 s: must be in simulated time, from -1.000 to 3.000 "
            "s");
  EXPECT_EQ(refusal_at_two_seconds(PoseEstimate{.stamp = -2s, .T_map_body = {}}),
            "message on /pose: stamp is -2.000 s: must be in simulated time, from -1.000 to 3.000 s");
  EXPECT_EQ(refusal_at_two_seconds(TrajectoryEstimate{.stamp = 2s, .T_map_body = {{1s, {}}, {9s, {}}}}),
            "message on /trajectory: stamp is 9.000 s: must be in simulated time, from -1.000 to 3.000 s");
}

TEST(CheckedMessage, RefusesNanosecondsOf4Billion) {
  link::PublishedMessage pose = published(PoseEstimate{.stamp = 1s, .T_map_body = {}});
  const std::uint32_t nanoseconds = 4'000'000'000;
  std::memcpy(pose.cdr.data() + 8, &nanoseconds, sizeof nanoseconds);
  EXPECT_EQ(refusal_of(pose), "message on /pose: nanosec of the stamp is 4000000000: must be below 1000000000");
}

TEST(CheckedMessage, RefusesAMapTurnedBy90Degrees) {
  link::PublishedMessage map = published(test::sample_map());
  const double one = 1.0, zero = 0.0;
  const std::string identity(reinterpret_cast<const char*>(&one), sizeof one);
  const std::size_t w = map.cdr.find(identity);
  ASSERT_NE(w, std::string::npos);
  for (const auto& [z, w_value] : {std::pair(std::sqrt(0.5), std::sqrt(0.5)), std::pair(zero, zero)}) {
    std::memcpy(map.cdr.data() + w - sizeof z, &z, sizeof z);
    std::memcpy(map.cdr.data() + w, &w_value, sizeof w_value);
    EXPECT_EQ(refusal_of(map),
              "message on /map: orientation of the origin must be the identity (x, y, z = 0, w = 1): rotated maps are "
              "not supported");
  }
}

TEST(CheckedMessage, RefusesAnOwnTopicThatOthersCannotRead) {
  const auto refusal = [](const std::string& topic, const std::string& definition, const std::string& cdr) {
    return refusal_of({.topic = topic, .type = "my/msg/X", .definition = definition, .cdr = cdr});
  };
  const std::string one = std::string("\x00\x01\x00\x00", 4) + std::string(8, '\0');
  EXPECT_EQ(refusal("/own", "float64 a\n", one), "");
  EXPECT_THAT(refusal("/own\xff", "float64 a\n", one), testing::HasSubstr("/own\\xff: name of a topic must begin"));
  EXPECT_EQ(refusal("/own", "float64 a # \xff\n", one), "message on /own: type and definition must be UTF-8");
  EXPECT_THAT(refusal("/own", "float64 a\n", ""), testing::HasSubstr("message on /own: not a my/msg/X"));
  EXPECT_THAT(refusal("/own", "float64 a\n", one.substr(0, 5)), testing::HasSubstr("message on /own: not a my/msg/X"));
  EXPECT_EQ(refusal("/own", "float64 a\nFoo b\n", one), "message on /own: message definition: type not found: Foo");
}

TEST(UnexpectedFrame, IsNamedForMessagesInMapOdomOrSite) {
  const auto frame_of = [](const auto& message, const std::string& frame, const std::string& written) {
    link::PublishedMessage one = published(message);
    const std::size_t at = one.cdr.find(written + '\0');
    one.cdr.replace(at, written.size(), frame);  // of the same length
    return unexpected_frame(checked_message(std::move(one)));
  };
  EXPECT_EQ(frame_of(test::sample_estimate(), "lid", "map"), "lid");
  EXPECT_EQ(frame_of(test::sample_odometry(), "oddm", "odom"), "oddm");
  EXPECT_EQ(frame_of(test::sample_registration(), "sita", "site"), "sita");
  EXPECT_FALSE(frame_of(test::sample_estimate(), "map", "map"));
  EXPECT_FALSE(frame_of(test::sample_command(), "base_camera_id", "base_footprint"));
}

TEST(UnexpectedFrame, IsNamedForThePosesOfAPath) {
  const auto frame_of = [](const auto& message, const std::string& frame) {
    link::PublishedMessage one = published(message);
    one.cdr.replace(one.cdr.rfind(std::string("map") + '\0'), frame.size(), frame);  // of the last pose
    return unexpected_frame(checked_message(std::move(one)));
  };
  const TrajectoryEstimate trajectory{.stamp = 2s, .T_map_body = {{1s, {}}, {2s, {}}}};
  EXPECT_EQ(frame_of(test::sample_path(), "odo"), "odo");
  EXPECT_EQ(frame_of(trajectory, "odo"), "odo");
  EXPECT_FALSE(frame_of(test::sample_path(), "map"));
  EXPECT_FALSE(frame_of(trajectory, "map"));
}

}  // namespace
}  // namespace patrol::app::checked_message_test
