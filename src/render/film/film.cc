#include "render/film/film.h"

#include <utility>

namespace patrol::render {

Film::Film(const mjModel& view, const FrameSettings& settings, double frames_per_second, Director director,
           const std::filesystem::path& out_mp4)
    : frames_per_second_(frames_per_second),
      director_(std::move(director)),
      video_(out_mp4, settings.width, settings.height, frames_per_second, director_.plan().chapters),
      painter_(view, settings) {}

void Film::add_snapshot(const RunSnapshot& snapshot) {
  constexpr std::size_t kMaxInWork = 4;
  const Time now = snapshot.state.stamp;
  while (now >= director_.plan().speed.run_time(num_frames_ / frames_per_second_)) {
    const View view = director_.view(snapshot, 1.0 / frames_per_second_);
    const bool has_note = director_.plan().style == FilmStyle::kHighlights;
    in_work_.push_back(painter_.paint(snapshot, view, has_note ? std::optional(director_.note(now)) : std::nullopt));
    ++num_frames_;
    if (in_work_.size() > kMaxInWork) encode_oldest_frame();
  }
}

void Film::finish() {
  while (!in_work_.empty()) encode_oldest_frame();
  video_.finish();
}

void Film::encode_oldest_frame() {
  video_.add(in_work_.front().get());
  in_work_.pop_front();
}

}  // namespace patrol::render
