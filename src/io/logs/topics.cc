#include "io/logs/topics.h"

#include <algorithm>
#include <type_traits>

namespace patrol::io {

std::vector<TopicInfo> topic_infos() {
  std::vector<TopicInfo> infos;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) { infos.push_back(topic_info<Message>()); });
  infos.insert(infos.end(), {kTransforms, kStaticTransforms});
  std::apply([&](const auto&... row) { (infos.push_back(row), ...); }, kTopicTable);
  return infos;
}

std::optional<TopicInfo> find_topic(std::string_view topic) {
  static const std::vector<TopicInfo> infos = topic_infos();
  const auto info = std::ranges::find_if(infos, [&](const TopicInfo& one) { return topic == one.topic; });
  return info != infos.end() ? std::optional(*info) : std::nullopt;
}

bool is_stack_input(std::string_view topic) {
  const std::optional<TopicInfo> info = find_topic(topic);
  if (!info) return false;
  const std::string_view source = info->source;
  return source == "sensor" || source == "firmware";
}

bool is_stack_output(std::string_view topic) {
  if (topic == kTransforms.topic || topic == kStaticTransforms.topic) return false;
  const std::optional<TopicInfo> info = find_topic(topic);
  return !info || std::string_view(info->source) == "stack";
}

}  // namespace patrol::io
