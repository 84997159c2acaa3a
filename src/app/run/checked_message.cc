#include "app/run/checked_message.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/frames.h"
#include "core/site/site_registration.h"
#include "io/files/one_line.h"
#include "io/logs/topics.h"
#include "io/ros/coordinate_limit.h"
#include "io/ros/path_frames.h"
#include "io/ros/ros_fields.h"
#include "io/ros/ros_messages.h"
#include "link/link_error.h"
#include "link/protocol.h"

namespace patrol::app {
namespace {

using link::LinkError;
using link::LinkFault;

constexpr std::size_t kMaxNameBytes = 200;
constexpr double kMinResolution_m = 1e-4;

bool has_finite_numbers(const stack::StackMessage& message) {
  return std::visit([](const auto& content) { return io::has_finite_numbers(content); }, message);
}

/// Returns whether the cells of a map have a size of at least 0.1 mm.
bool has_resolution(const stack::StackMessage& message) {
  const auto* update = std::get_if<MapUpdate>(&message);
  return update == nullptr || update->map.geometry().resolution_m >= kMinResolution_m;
}

double max_coordinate_m(const stack::StackMessage& message) {
  return std::visit([](const auto& content) { return io::max_coordinate_m(content); }, message);
}

/// Returns the first cell of a map that is neither unknown (-1) nor a probability in percent.
std::optional<int> invalid_cell(const stack::StackMessage& message) {
  const auto* update = std::get_if<MapUpdate>(&message);
  if (update == nullptr) return std::nullopt;
  const auto& cells = update->map.values();
  const auto invalid = std::ranges::find_if(cells, [](int cell) { return cell < -1 || cell > 100; });
  return invalid == cells.end() ? std::nullopt : std::optional<int>(*invalid);
}

/// Returns whether the rotations of a message are unit quaternions. `content`: of the message; its planar poses no
/// longer have them.
bool has_unit_quaternions(const stack::StackMessage& content, std::string_view cdr) {
  return std::visit([&]<typename Content>(const Content&) { return io::has_unit_quaternions<Content>(cdr); }, content);
}

/// Returns the texts of a message with their names.
std::vector<std::pair<std::string_view, std::string_view>> texts_of(const stack::StackMessage& message) {
  std::vector<std::pair<std::string_view, std::string_view>> texts;
  if (const auto* event = std::get_if<Event>(&message)) {
    texts = {{"kind", event->foreign_kind}, {"subject", event->subject}, {"text", event->text}};
  } else if (const auto* lining = std::get_if<LiningResult>(&message)) {
    texts = {{"station", lining->station}};
    for (const ConvergenceLine& line : lining->lines) texts.emplace_back("name of a line", line.name);
  } else if (const auto* water = std::get_if<WaterResult>(&message)) {
    texts = {{"station", water->station}};
  } else if (const auto* calibration = std::get_if<CalibrationEstimate>(&message)) {
    for (const CalibrationValue& value : calibration->values) texts.emplace_back("name of a value", value.name);
  }
  return texts;
}

/// Returns the stamps of a message: that of its header and, of a trajectory, those of its poses.
std::vector<Time> stamps_of(const io::MessageHeader& header, const stack::StackMessage& content) {
  std::vector<Time> stamps = {header.stamp()};
  if (const auto* trajectory = std::get_if<TrajectoryEstimate>(&content))
    std::ranges::transform(trajectory->T_map_body, std::back_inserter(stamps), &StampedPose::stamp);
  return stamps;
}

/// Returns the frame that Patrol writes in a message of a type, by index of the type.
std::vector<std::string> frames_of_types() {
  return []<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    return std::vector<std::string>{
        io::header_of(io::encode(std::variant_alternative_t<kIndex, stack::StackMessage>{})).frame...};
  }
  (std::make_index_sequence<std::variant_size_v<stack::StackMessage>>{});
}

/// Throws InputError if a stack must not publish a topic.
void check_topic(const std::string& topic) {
  if (!topic.starts_with('/') || topic.size() > kMaxNameBytes || !io::is_utf8(topic) ||
      io::has_control_characters(topic)) {
    throw InputError("name of a topic must begin with / and have at most 200 printable characters in UTF-8");
  }
  if (topic == link::kControlTopic<link::HelloReply>)
    throw InputError("only the first message of a stack answers the hello");
  if (topic.starts_with("/link/") || topic.starts_with("/recorded/") || !io::is_stack_output(topic))
    throw InputError("only the simulator writes this topic");
}

/// Checks a message of a topic that Patrol does not define. Throws InputError if it is not of its type.
PublishedMessage foreign_message(link::PublishedMessage message) {
  for (const std::string* text : {&message.type, &message.definition}) {
    if (!io::is_utf8(*text)) throw InputError("type and definition must be UTF-8");
  }
  io::check_ros_message(message.type, message.definition, message.cdr);
  return {.content = {},
          .topic = std::move(message.topic),
          .type = std::move(message.type),
          .definition = std::move(message.definition),
          .cdr = std::move(message.cdr)};
}

/// Throws InputError if stamps, texts or numbers of a message are invalid.
void check_content(const stack::StackMessage& content, const std::string& cdr, const StampRange& stamps) {
  const io::MessageHeader header = io::header_of(cdr);
  if (header.nanoseconds >= 1'000'000'000U)
    throw InputError(fmt::format("nanosec of the stamp is {}: must be below 1000000000", header.nanoseconds));
  for (const Time stamp : stamps_of(header, content)) {
    if (stamp >= stamps.from && stamp <= stamps.to) continue;
    throw InputError(fmt::format("stamp is {:.3f} s: must be in simulated time, from {:.3f} to {:.3f} s",
                                 to_seconds(stamp), to_seconds(stamps.from), to_seconds(stamps.to)));
  }
  for (const auto& [name, text] : texts_of(content)) {
    if (!io::is_utf8(text)) throw InputError(fmt::format("{} is not UTF-8", name));
  }
  if (!has_finite_numbers(content)) throw InputError("contains a number that is not finite");
  if (const double coordinate_m = max_coordinate_m(content); coordinate_m > io::kMaxCoordinate_m) {
    throw InputError(
        fmt::format("contains a position with a coordinate of {:g} m: must be within {:.0f} m of the origin of its "
                    "frame",
                    coordinate_m, io::kMaxCoordinate_m));
  }
  if (!has_resolution(content)) throw InputError("resolution must be at least 0.0001 m");
  if (const std::optional<int> cell = invalid_cell(content))
    throw InputError(fmt::format("a cell of the map is {}: must be in [-1, 100]", *cell));
  if (!has_unit_quaternions(content, cdr)) throw InputError("contains a quaternion whose norm is not 1");
}

}  // namespace

std::string quoted_name(const std::string& name) { return io::on_one_line(io::first_bytes(name, kMaxNameBytes)); }

std::optional<std::string> expected_frame(const stack::StackMessage& content) {
  static const std::vector<std::string> frames = frames_of_types();
  const std::string& frame = frames[content.index()];
  const bool is_fixed = frame == frame_id::kMap || frame == frame_id::kOdom || frame == frame_id::kSite;
  return is_fixed ? std::optional(frame) : std::nullopt;
}

std::optional<std::string> unexpected_frame(const PublishedMessage& message) {
  if (!message.content) return std::nullopt;
  const std::optional<std::string> expected = expected_frame(*message.content);
  if (!expected) return std::nullopt;
  std::vector<std::string> frames = {io::header_of(message.cdr).frame};
  if (std::holds_alternative<Path>(*message.content) || std::holds_alternative<TrajectoryEstimate>(*message.content))
    frames = io::path_frames_of(message.cdr);
  for (std::string& frame : frames) {
    if (frame.starts_with('/')) frame.erase(0, 1);  // ROS 1
    if (!frame.empty() && frame != *expected) return frame;
  }
  return std::nullopt;
}

PublishedMessage checked_message(link::PublishedMessage message, const StampRange& stamps) {
  const std::string where = message.topic.empty() ? "a topic without a name" : quoted_name(message.topic);
  try {
    check_topic(message.topic);
    const std::optional<io::TopicInfo> info = io::find_topic(message.topic);
    if (!info) return foreign_message(std::move(message));
    if (message.type != info->type)
      throw InputError(fmt::format("type is {}: must be {}", quoted_name(message.type), info->type));
    PublishedMessage checked{.content = {}, .topic = std::move(message.topic), .cdr = std::move(message.cdr)};
    checked.content = io::decode_as<stack::StackMessage>(checked.topic, checked.cdr);
    if (checked.content) check_content(*checked.content, checked.cdr, stamps);
    return checked;
  } catch (const InputError& error) {
    throw LinkError(LinkFault::kInvalid, fmt::format("message on {}: {}", where, error.what()));
  }
}

}  // namespace patrol::app
