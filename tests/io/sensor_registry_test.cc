#include <string>

#include <gtest/gtest.h>

#include "core/sensors/registry.h"
#include "io/logs/run_log.h"
#include "io/ros/ros_definitions.h"
#include "io/ros/ros_fields.h"
#include "io/ros/ros_messages.h"

namespace patrol::io::sensor_registry_test {
namespace {

/// Message with a stamp and, where an empty message has one, a main reading away from zero.
template <typename Message>
Message sample() {
  Message message;
  message.stamp = from_seconds(12.5);
  SensorTraits<Message>::add_to_reading(message, 2.0);
  return message;
}

TEST(SensorRegistry, EverySensorsMessageComesBackFromItsRosEncoding) {
  Sensors::for_each([]<typename Message>(std::type_identity<Message>) {
    const std::string bytes = encode(sample<Message>());
    const auto decoded = decode<Message>(bytes);
    EXPECT_EQ(decoded.stamp, from_seconds(12.5)) << SensorTraits<Message>::kInfo.name;
    EXPECT_EQ(encode(decoded), bytes) << SensorTraits<Message>::kInfo.name;
  });
}

TEST(SensorRegistry, TheDefinitionOfEverySensorsTypeDescribesItsBytes) {
  Sensors::for_each([]<typename Message>(std::type_identity<Message>) {
    const std::string type = kRosType<Message>;
    const auto fields = ros_fields(type, ros_definition(type), encode(sample<Message>()));
    ASSERT_GE(fields.size(), 3u) << type;
    EXPECT_EQ(fields[0].path, "header.stamp.sec") << type;
    EXPECT_EQ(fields[0].value, "12") << type;
  });
}

TEST(SensorRegistry, TheLogWritesEverySensorOnTheTopicOfTheRegistry) {
  Sensors::for_each([]<typename Message>(std::type_identity<Message>) {
    EXPECT_STREQ(kTopic<Message>, SensorTraits<Message>::kInfo.topic);
  });
}

}  // namespace
}  // namespace patrol::io::sensor_registry_test
