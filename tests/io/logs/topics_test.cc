#include "io/logs/topics.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/io/sample_messages.h"

namespace patrol::io::topics_test {
namespace {

TEST(Topics, EachIsListedOnceWithATypeAndASummary) {
  std::set<std::string> topics;
  for (const TopicInfo& info : topic_infos()) {
    ASSERT_NE(info.topic, nullptr);
    EXPECT_TRUE(topics.insert(info.topic).second) << info.topic;
    EXPECT_TRUE(std::string(info.topic).starts_with("/")) << info.topic;
    EXPECT_NE(std::string(info.type).find("/msg/"), std::string::npos) << info.topic;
    EXPECT_GT(std::string(info.summary).size(), 6U) << info.topic;
  }
}

TEST(Topics, EveryLoggedMessageIsListed) {
  const std::vector<TopicInfo> infos = topic_infos();
  const auto expect_listed = [&]<typename Message>(const Message&) {
    if constexpr (!std::is_same_v<Message, TransformSet>) {
      const std::string topic = kTopic<Message>;
      EXPECT_TRUE(std::ranges::any_of(infos, [&](const TopicInfo& info) { return info.topic == topic; })) << topic;
    }
  };
  std::apply([&](const auto&... message) { (expect_listed(message), ...); }, test::all_samples());
}

}  // namespace
}  // namespace patrol::io::topics_test
