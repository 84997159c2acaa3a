#include "io/logs/topics.h"

#include <type_traits>

namespace patrol::io {

std::vector<TopicInfo> topic_infos() {
  std::vector<TopicInfo> infos;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) { infos.push_back(topic_info<Message>()); });
  infos.insert(infos.end(), {kTransforms, kStaticTransforms});
  std::apply([&](const auto&... row) { (infos.push_back(row), ...); }, kTopicTable);
  return infos;
}

}  // namespace patrol::io
