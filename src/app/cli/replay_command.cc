#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <new>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "app/campaign/batch/batch_options.h"
#include "app/campaign/batch/process_pool.h"
#include "app/cli/commands.h"
#include "app/common/progress_bar.h"
#include "app/record/run_directory.h"
#include "app/record/run_record.h"
#include "app/run/run_loop.h"
#include "core/error.h"
#include "render/film/replay.h"

namespace patrol::app {
namespace {

constexpr int kMinSize = 64, kMaxSize = 3840;
constexpr double kRenderTimeout_s = 86400.0;  // of one process

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

render::ReplaySettings replay_settings(const ReplayOptions& options) {
  render::ReplaySettings settings;
  settings.style = render::parse_film_style(options.style);
  settings.camera = render::parse_camera_kind(options.camera);
  settings.renderer = render::parse_renderer(options.renderer);
  settings.speed.fast = checked_speed("--speed", options.speed);
  settings.speed.slow = checked_speed("--highlight-speed", options.highlight_speed);
  settings.frames_per_second = checked_speed("--fps", options.frames_per_second);
  std::tie(settings.width, settings.height) = parse_size(options.size);
  return settings;
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

/// Memory that this process has in common with processes forked from it: completed fraction of each part.
class SharedProgress {
 public:
  explicit SharedProgress(std::size_t num_parts) : num_parts_(num_parts) {
    void* memory = ::mmap(nullptr, bytes(), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("cannot allocate shared memory");
    done_ = static_cast<std::atomic<double>*>(memory);
    for (std::size_t i = 0; i < num_parts_; ++i) new (done_ + i) std::atomic<double>(0.0);
  }
  ~SharedProgress() { ::munmap(done_, bytes()); }
  SharedProgress(const SharedProgress&) = delete;
  SharedProgress& operator=(const SharedProgress&) = delete;

  void set(std::size_t part, double done) { done_[part] = done; }
  double mean() const { return std::accumulate(done_, done_ + num_parts_, 0.0) / static_cast<double>(num_parts_); }

 private:
  std::size_t bytes() const { return num_parts_ * sizeof(std::atomic<double>); }

  std::size_t num_parts_;
  std::atomic<double>* done_ = nullptr;
};

/// Removes the segments of a film at the end of its lifetime, also after an error.
struct SegmentRemover {
  const render::ReplayFilm& film;
  ~SegmentRemover() { film.remove_segments(); }
};

/// Renders all segments of a film, in up to `jobs` processes (0: one per core). Returns false if interrupted.
bool render_in_processes(const render::ReplayFilm& film, int jobs) {
  const BatchSettings batch = batch_settings({.jobs = jobs, .run_timeout_s = kRenderTimeout_s, .keep_runs = "none"});
  const int num_parts = std::clamp(film.num_segments(), 1, batch.pool.num_processes);
  ProgressBar bar;
  const InterruptGuard interrupt;
  const auto show = [&](double done) { bar.show(fmt::format("replay  {:3.0f} %", 100.0 * done), done); };
  if (num_parts == 1) {
    return film.render(0, 1, [&](double done) {
      show(done);
      return !interrupt.is_interrupted();
    });
  }
  SharedProgress progress(static_cast<std::size_t>(num_parts));
  ProcessPoolSettings pool = batch.pool;
  pool.num_processes = num_parts;
  const auto render_part = [&](std::size_t part) {
    ::setenv("LP_NUM_THREADS", "1", 1);  // the rasterizer of OSMesa would start a thread per core in each process
    film.render(static_cast<int>(part), num_parts, [&](double done) {
      progress.set(part, done);
      return true;
    });
    return 0;
  };
  const auto on_end = [&](const TaskEnd& end) {
    if (end.exit_code != 0 || end.signal != 0)
      throw std::runtime_error(fmt::format("replay: part {} failed: {}", end.task, end.last_stderr_line));
  };
  return run_in_processes(static_cast<std::size_t>(num_parts), pool, render_part, on_end, [&] {
    show(progress.mean());
    return !interrupt.is_interrupted();
  });
}

}  // namespace

ExitCode replay_command(const ReplayOptions& options) {
  render::ReplaySettings settings = replay_settings(options);
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
  if (!record.has_estimate()) throw InputError(fmt::format("{}: contains no pose estimate", directory.log().string()));
  const Pose2 T_world_map = pose_of_map(record, files.map ? std::optional(files.T_site_map()) : std::nullopt);
  sim::AssembledModel model = sim::assemble_model(files.world_xml.string(), files.robot_urdf.string(),
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
  const SegmentRemover segments{film};
  if (render_in_processes(film, options.jobs)) {
    film.join();
  } else {
    fmt::print(stderr, "patrol: interrupted; no video written\n");
    return ExitCode::kProgramFailed;
  }
  fmt::print("{}: {} frames, {} chapters, {:.1f} s of the run{}\n", out.string(), film.num_frames(),
             film.num_chapters(), to_seconds(film.end()), film.log_is_complete() ? "" : ", incomplete log");
  return ExitCode::kDone;
}

}  // namespace patrol::app
