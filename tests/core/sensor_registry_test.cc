#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "core/sensors/registry.h"

namespace patrol::sensor_registry_test {
namespace {

TEST(SensorRegistry, NamesAndTopicsAreUniqueAndEveryEntryIsDocumented) {
  std::set<std::string> names, topics;
  for (const SensorInfo& info : kSensorInfos) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_TRUE(topics.insert(info.topic).second) << info.topic;
    EXPECT_EQ(info.topic[0], '/') << info.name;
    EXPECT_STRNE(info.summary, "") << info.name;
    EXPECT_NE(std::string(info.ros_type).find("/msg/"), std::string::npos) << info.name;
  }
  EXPECT_EQ(names.size(), std::variant_size_v<SensorMessage>);
}

TEST(SensorRegistry, EverySensorHasFaultMagnitudesOrAReasonNotToBeInTheFaultMatrix) {
  for (const SensorInfo& info : kSensorInfos) {
    const bool has_magnitudes = info.fault.drift_per_s > 0.0 && info.fault.outlier > 0.0 && *info.fault.unit != '\0';
    const bool has_reason = *info.fault_matrix_exclusion_reason != '\0';
    EXPECT_NE(has_magnitudes, has_reason) << info.name;
  }
}

TEST(SensorRegistry, ASensorThatDrivingNeedsIsMonitored) {
  for (const SensorInfo& info : kSensorInfos) {
    EXPECT_TRUE(!info.is_required_to_drive || info.timeout != SensorTimeout::kNone) << info.name;
  }
}

TEST(SensorRegistry, AFreezeCheckComesWithAComparisonOfReadings) {
  Sensors::for_each([]<typename Message>(std::type_identity<Message>) {
    constexpr bool kCompares = requires(const Message& message) { SensorTraits<Message>::repeats(message, message); };
    EXPECT_EQ(kCompares, SensorTraits<Message>::kInfo.freeze_check != FreezeCheck::kNone)
        << SensorTraits<Message>::kInfo.name;
  });
}

TEST(SensorRegistry, AnEmptyMessageBearsAnOffset) {
  Sensors::for_each([]<typename Message>(std::type_identity<Message>) {
    Message message;
    SensorTraits<Message>::add_to_reading(message, 1.0);
    EXPECT_EQ(message.stamp, Time{});
  });
}

TEST(SensorRegistry, OverridesOfErrorSourcesNameSettings) {
  Sensors::for_each([]<typename Message>(std::type_identity<Message>) {
    const std::string own = std::string("sensors.") + SensorTraits<Message>::kInfo.name + ".";
    for (const ErrorSource& source : error_sources<Message>()) {
      EXPECT_FALSE(source.overrides.empty()) << source.name;
      EXPECT_TRUE(source.overrides.front().starts_with(own)) << source.name;
    }
  });
}

}  // namespace
}  // namespace patrol::sensor_registry_test
