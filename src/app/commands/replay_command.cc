#include <charconv>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/film/render_film.h"
#include "app/record/run_directory.h"
#include "app/record/run_record.h"
#include "app/run/make_simulator.h"
#include "app/scenario/data_folders.h"
#include "core/error.h"
#include "render/film/replay.h"

namespace patrol::app {
namespace {

constexpr int kMinSize = 64, kMaxSize = 3840;

/// Parses "1280x720". The encoder takes even sizes only.
std::pair<int, int> parse_size(const std::string& text) {
  int width = 0, height = 0;
  const char* end = text.data() + text.size();
  const auto [cross, bad_width] = std::from_chars(text.data(), end, width);
  const bool has_cross = bad_width == std::errc{} && cross != end && *cross == 'x';
  const auto [rest, bad_height] =
      has_cross ? std::from_chars(cross + 1, end, height) : std::from_chars_result{cross, bad_width};
  const auto is_fine = [](int value) { return value >= kMinSize && value <= kMaxSize && value % 2 == 0; };
  if (!has_cross || bad_height != std::errc{} || rest != end || !is_fine(width) || !is_fine(height)) {
    throw InputError(
        fmt::format("--size {}: must be WIDTHxHEIGHT, even numbers of pixels in [{}, {}]", text, kMinSize, kMaxSize));
  }
  return {width, height};
}

double checked_speed(const char* option, double speed) {
  if (!(speed > 0.0 && speed <= 1000.0)) throw InputError(fmt::format("{} {}: must be in (0, 1000]", option, speed));
  return speed;
}

/// Parses the name that an option has as its value. Throws InputError that begins with the option.
template <typename Choice>
Choice parse_choice(const char* option, const std::string& name, Choice (*parse)(const std::string&)) {
  try {
    return parse(name);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{} {}", option, error.what()));
  }
}

render::ReplaySettings replay_settings(const ReplayOptions& options) {
  render::ReplaySettings settings;
  settings.style = parse_choice("--style", options.style, render::parse_film_style);
  settings.camera = parse_choice("--camera", options.camera, render::parse_camera_kind);
  settings.renderer = parse_choice("--renderer", options.renderer, render::parse_renderer);
  settings.speed.fast = checked_speed("--speed", options.speed);
  settings.speed.slow = checked_speed("--highlight-speed", options.highlight_speed);
  settings.frames_per_second = checked_speed("--fps", options.frames_per_second);
  std::tie(settings.width, settings.height) = parse_size(options.size);
  return settings;
}

/// Throws InputError unless the name of the output file ends with a format that can be written.
void check_output_name(const std::filesystem::path& out, bool is_still) {
  const std::string extension = out.extension().string();
  if (is_still && extension != ".png") throw InputError(fmt::format("--out {}: must end with .png", out.string()));
  if (!is_still && extension != ".mp4" && extension != ".webp")
    throw InputError(fmt::format("--out {}: must end with .mp4 or .webp", out.string()));
}

/// Highlights at the start of faults. They come from the scenario because the log does not contain them.
std::vector<render::Highlight> fault_highlights(const std::vector<sim::FaultSettings>& faults) {
  std::vector<render::Highlight> highlights;
  for (const sim::FaultSettings& fault : faults) {
    highlights.push_back(
        {.at = from_seconds(fault.start_s),
         .kind = render::HighlightKind::kFault,
         .title = fmt::format("Fault: {} of {} for {:g} s", fault.kind, fault.sensor, fault.duration_s)});
  }
  return highlights;
}

}  // namespace

ExitCode replay_command(const ReplayOptions& options) {
  render::ReplaySettings settings = replay_settings(options);
  if (options.out) check_output_name(*options.out, options.still_s.has_value());
  const RunDirectory directory = open_run_directory(options.run);
  const Scenario scenario = load_scenario(directory.scenario());
  const ScenarioFiles files = load_scenario_files(scenario, find_data_root(directory.scenario()));
  settings.dust = scenario.sensors.dust;
  settings.light = scenario.light;
  settings.leaks = scenario.leaks;
  settings.wind = scenario.wind;
  settings.announced = fault_highlights(scenario.faults);
  settings.map = files.map;
  const RunRecord record = read_run_record(directory.log());
  const Pose2 T_world_map = pose_of_map(record, files.map ? std::optional(files.T_site_map()) : std::nullopt);
  sim::AssembledModel model = sim::assemble_model(files.world_xml.string(), files.simulated_robot(), files.robot,
                                                  start_in_world(scenario, files), all_static_obstacles(scenario));

  if (options.still_s) {
    const Time at = from_seconds(*options.still_s);
    if (at < Time::zero() || at > record.T_world_body.back().stamp) {
      throw InputError(fmt::format("--still {}: must be in [0, {:.1f}], the duration of the run", *options.still_s,
                                   to_seconds(record.T_world_body.back().stamp)));
    }
    const std::filesystem::path out =
        options.out.value_or(directory.root / fmt::format("still_{}_{:g}s.png", options.camera, *options.still_s));
    render::still(directory.log(), std::move(model), T_world_map, settings, at, out);
    fmt::print("{}\n", out.string());
    return ExitCode::kDone;
  }
  const std::filesystem::path out = options.out.value_or(directory.root / "replay.mp4");
  const render::ReplayFilm film(directory.log(), std::move(model), T_world_map, settings, out);
  if (!render_film(film, options.jobs)) {
    fmt::print(stderr, "patrol: interrupted; no video written\n");
    return ExitCode::kProgramFailed;
  }
  fmt::print("{}: {} frames, {} chapters, {:.1f} s of the run{}\n", out.string(), film.num_frames(),
             film.num_chapters(), to_seconds(film.end()), film.log_is_complete() ? "" : ", incomplete log");
  return ExitCode::kDone;
}

}  // namespace patrol::app
