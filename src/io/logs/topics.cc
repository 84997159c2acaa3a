#include "io/logs/topics.h"

#include <string_view>
#include <type_traits>
#include <unordered_map>

namespace patrol::io {

std::vector<TopicInfo> topic_infos() {
  std::vector<TopicInfo> infos;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) { infos.push_back(topic_info<Message>()); });
  infos.insert(infos.end(), {kTransforms, kStaticTransforms});
  std::apply([&](const auto&... row) { (infos.push_back(row), ...); }, kTopicTable);
  return infos;
}

std::optional<TopicInfo> find_topic(std::string_view topic) {
  static const std::unordered_map<std::string_view, TopicInfo> infos = [] {
    std::unordered_map<std::string_view, TopicInfo> by_topic;
    for (const TopicInfo& info : topic_infos()) by_topic.emplace(info.topic, info);
    return by_topic;
  }();
  const auto info = infos.find(topic);
  return info != infos.end() ? std::optional(info->second) : std::nullopt;
}

bool is_stack_input(std::string_view topic) {
  const std::optional<TopicInfo> info = find_topic(topic);
  if (!info) return false;
  const std::string_view source = info->source;
  return source == "sensor" || source == "firmware";
}

bool is_stack_output(std::string_view topic) {
  const std::optional<TopicInfo> info = find_topic(topic);
  return !info || std::string_view(info->source) == "stack";
}

}  // namespace patrol::io
