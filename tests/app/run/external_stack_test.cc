#include "app/run/external_stack.h"

#include <limits>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "io/logs/topics.h"
#include "io/ros/ros_messages.h"
#include "link/link_error.h"
#include "tests/io/sample_messages.h"

namespace patrol::app::external_stack_test {
namespace {

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

TEST(CheckedMessage, RefusesAMapOfResolution0ByItsResolution) {
  EXPECT_EQ(refusal_of(published(MapUpdate{
                .stamp = {}, .map = OccupancyGrid({.resolution_m = 0.0, .width = 1, .height = 1}, kUnknown)})),
            "message on /map: resolution must be at least 0.0001 m");
}

}  // namespace
}  // namespace patrol::app::external_stack_test
