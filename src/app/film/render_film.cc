#include "app/film/render_film.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>

#include "app/campaign/batch/batch_options.h"
#include "app/campaign/batch/process_pool.h"
#include "app/common/progress_bar.h"
#include "app/film/shared_progress.h"

namespace patrol::app {
namespace {

constexpr double kRenderTimeout_s = 86400.0;  // of one process

/// Removes the segments of a film at the end of its lifetime, also after an error.
struct SegmentRemover {
  const render::ReplayFilm& film;
  ~SegmentRemover() { film.remove_segments(); }
};

/// Renders all segments of a film, in up to `jobs` processes (0: one per core). Returns false if interrupted.
bool render_segments(const render::ReplayFilm& film, int jobs) {
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

bool render_film(const render::ReplayFilm& film, int jobs) {
  const SegmentRemover segments{film};
  if (!render_segments(film, jobs)) return false;
  film.join();
  return true;
}

}  // namespace patrol::app
