#include "io/logs/topics.h"

#include <variant>

#include <gtest/gtest.h>

namespace patrol::io {
namespace {

TEST(Topics, TheStackReceivesSensorsAndFirmwareOnly) {
  for (const char* topic : {"/scan", "/imu/data", "/track_ticks", "/fall"}) EXPECT_TRUE(is_stack_input(topic)) << topic;
  for (const char* topic :
       {"/ground_truth/odom", "/ground_truth/as_built", "/sim/state", "/stack/turns", "/cmd_vel", "/tf", "/mine"}) {
    EXPECT_FALSE(is_stack_input(topic)) << topic;
  }
}

TEST(Topics, TheStackPublishesItsOwnTopicsAndThoseThatTheProgramDoesNotKnow) {
  for (const char* topic : {"/cmd_vel", "/pose", "/events", "/mine"}) EXPECT_TRUE(is_stack_output(topic)) << topic;
  for (const char* topic : {"/scan", "/fall", "/ground_truth/odom", "/sim/state", "/stack/turns", "/tf", "/tf_static"})
    EXPECT_FALSE(is_stack_output(topic)) << topic;
  for (const TopicInfo& info : topic_infos())
    EXPECT_EQ(is_stack_output(info.topic), std::string_view(info.source) == "stack") << info.topic;
}

TEST(Topics, AMessageIsDecodedIntoTheAlternativeOfItsTopic) {
  using Variant = std::variant<VelocityCommand, FallReport>;
  const std::string cdr = encode(FallReport{std::chrono::milliseconds(1500)});
  const std::optional<Variant> decoded = decode_as<Variant>("/fall", cdr);
  ASSERT_TRUE(decoded && std::holds_alternative<FallReport>(*decoded));
  EXPECT_EQ(std::get<FallReport>(*decoded).stamp, std::chrono::milliseconds(1500));
  EXPECT_FALSE(decode_as<Variant>("/scan", cdr).has_value());
  EXPECT_THROW(decode_as<Variant>("/cmd_vel", cdr), DecodeError);
}

}  // namespace
}  // namespace patrol::io
