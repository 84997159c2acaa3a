#include "app/mapping/submap_graph_files.h"

#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/common/output_directory.h"
#include "core/error.h"
#include "io/files/csv.h"
#include "io/files/line_reader.h"
#include "io/files/line_tokenizer.h"
#include "io/mcap/mcap_reader.h"
#include "io/mcap/mcap_writer.h"
#include "io/ros/ros_definitions.h"
#include "io/ros/ros_messages.h"
#include "io/trajectories/g2o.h"

namespace patrol::app {
namespace {

constexpr const char* kGraphFile = "pose_graph.g2o";
constexpr const char* kSubmapsFile = "submaps.csv";
constexpr const char* kKeyframesFile = "keyframes.mcap";
constexpr const char* kTopic = "/keyframes";

void save_keyframes(const std::filesystem::path& file, const std::vector<slam::Keyframe>& keyframes) {
  io::McapWriter writer(file);
  const std::string type = io::kRosType<io::KeyframeScans>;
  const io::McapWriter::ChannelId channel = writer.add_channel(kTopic, type, io::ros_definition(type));
  for (const slam::Keyframe& keyframe : keyframes) {
    const Time stamp = keyframe.scans.stamp();
    writer.write(channel, stamp, io::encode(io::KeyframeScans{.stamp = stamp, .scans = keyframe.scans.scans()}));
  }
  writer.close();
}

std::vector<slam::ScanGroup> load_keyframes(const std::filesystem::path& file) {
  std::vector<slam::ScanGroup> keyframes;
  const auto add = [&](const io::McapMessage& message) {
    try {
      keyframes.emplace_back(io::decode<io::KeyframeScans>(message.cdr).scans);
    } catch (const io::DecodeError& error) {
      throw InputError(fmt::format("{}: keyframe {}: {}", file.string(), keyframes.size(), error.what()));
    }
  };
  if (!io::read_mcap(file, add, {.topics = {kTopic}})) throw InputError(file.string() + ": is truncated");
  return keyframes;
}

std::vector<slam::Submap> load_submaps(const std::filesystem::path& file) {
  std::vector<slam::Submap> submaps;
  io::LineReader lines(file);
  while (const auto line = lines.next()) {
    if (line->number == 1) continue;  // names of the columns
    try {
      const std::size_t comma = line->text.find(',');
      if (line->is_cut || comma == std::string_view::npos) throw io::ParseError("must be FIRST,LAST");
      const auto index = [&](std::string_view text, const char* name) {
        io::LineTokenizer words(text);
        const auto value = static_cast<int>(words.integer(name, 0, std::numeric_limits<int>::max()));
        if (!words.is_empty()) throw io::ParseError("too many words");
        return value;
      };
      submaps.push_back({.first = index(line->text.substr(0, comma), "first keyframe"),
                         .last = index(line->text.substr(comma + 1), "last keyframe")});
    } catch (const io::ParseError& error) {
      throw input_error(file.string(), line->number, error.what());
    }
  }
  if (lines.read_error()) throw InputError(fmt::format("{}: {}", file.string(), *lines.read_error()));
  return submaps;
}

}  // namespace

void save_submap_graph(const std::filesystem::path& directory, const slam::SubmapGraph& map) {
  io::save_g2o(directory / kGraphFile, map.graph);
  io::Table submaps{.name = "submaps", .columns = {"first_keyframe", "last_keyframe"}, .rows = {}};
  for (const slam::Submap& submap : map.submaps)
    submaps.rows.push_back({std::int64_t{submap.first}, std::int64_t{submap.last}});
  io::save_csv(directory / kSubmapsFile, submaps);
  save_keyframes(directory / kKeyframesFile, map.keyframes);
}

slam::SubmapGraph load_submap_graph(const std::filesystem::path& directory) {
  if (std::filesystem::exists(incomplete_marker(directory)))
    throw InputError(directory.string() + ": is incomplete: the command that writes it has not finished");
  std::vector<slam::ScanGroup> keyframes = load_keyframes(directory / kKeyframesFile);
  std::vector<slam::Submap> submaps = load_submaps(directory / kSubmapsFile);
  PoseGraph graph = io::load_g2o(directory / kGraphFile);
  try {
    return slam::make_submap_graph(std::move(keyframes), std::move(submaps), std::move(graph));
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", directory.string(), error.what()));
  }
}

}  // namespace patrol::app
