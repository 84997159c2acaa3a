#include "app/cli/reference.h"

#include <span>
#include <string>

#include "app/cli/command_arguments.h"
#include "app/scenario/setting_keys.h"
#include "app/scoring/metric_infos.h"
#include "core/event.h"
#include "io/logs/topics.h"

namespace patrol::app {
namespace {

io::Metrics commands_json(const CLI::App& app) {
  io::Metrics commands = io::Metrics::array();
  for (const CLI::App* command : commands_of(app)) {
    io::Metrics json{{"name", command->get_name()},
                     {"summary", command->get_description()},
                     {"aliases", command->get_aliases()},
                     {"arguments", io::Metrics::array()},
                     {"options", io::Metrics::array()}};
    for (const CLI::Option* positional : positionals_of(*command)) {
      json["arguments"].push_back({{"name", positional->get_name()},
                                   {"is_required", positional->get_required()},
                                   {"summary", positional->get_description()}});
    }
    for (const CLI::Option* option : options_of(*command)) {
      json["options"].push_back({{"name", long_name(*option)},
                                 {"takes_value", takes_value(*option)},
                                 {"default", option->get_default_str()},
                                 {"is_required", option->get_required()},
                                 {"summary", option->get_description()}});
    }
    commands.push_back(json);
  }
  return commands;
}

io::Metrics settings_json() {
  io::Metrics settings = io::Metrics::array();
  for (const SettingKey& key : setting_keys()) {
    settings.push_back({{"path", key.path},
                        {"owner", key.owner},
                        {"type", key.type},
                        {"default", key.default_value},
                        {"limits", key.limits}});
  }
  return settings;
}

io::Metrics metrics_json() {
  io::Metrics metrics = io::Metrics::array();
  for (const MetricInfo& info : metric_infos()) metrics.push_back({{"path", info.path}, {"summary", info.summary}});
  return metrics;
}

io::Metrics events_json() {
  io::Metrics events = io::Metrics::array();
  for (const auto& row : kEventKinds) events.push_back({{"name", row.name}, {"summary", row.summary}});
  return events;
}

io::Metrics topics_json() {
  io::Metrics topics = io::Metrics::array();
  for (const io::TopicInfo& info : io::topic_infos()) {
    topics.push_back({{"topic", info.topic}, {"type", info.type}, {"source", info.source}, {"summary", info.summary}});
  }
  return topics;
}

}  // namespace

io::Metrics reference_json(const CLI::App& app) {
  return {{"commands", commands_json(app)},
          {"settings", settings_json()},
          {"metrics", metrics_json()},
          {"events", events_json()},
          {"topics", topics_json()}};
}

}  // namespace patrol::app
