#include "render/film/film.h"

#include <utility>

#include <fmt/format.h>

namespace patrol::render {

std::filesystem::path FilmSegments::file(int segment) const {
  return folder / fmt::format("segment_{:04}{}", segment, extension);
}

Film::Film(const mjModel& view, const FrameSettings& settings, double frames_per_second, Director director,
           FilmSegments segments)
    : settings_(settings),
      frames_per_second_(frames_per_second),
      director_(std::move(director)),
      segments_(std::move(segments)),
      painter_(view, settings) {}

void Film::add_snapshot(const RunSnapshot& snapshot) {
  constexpr std::size_t kMaxInWork = 4;
  const Time now = snapshot.state.stamp;
  while (now >= director_.plan().speed.run_time(num_frames_ / frames_per_second_)) {
    const View view = director_.view(snapshot, 1.0 / frames_per_second_);  // also of other parts: the camera moves
    const int segment = num_frames_++ / segments_.frames_per_segment;
    if (!segments_.contains(segment)) continue;
    const bool has_note = director_.plan().style == FilmStyle::kHighlights;
    in_work_.push_back(
        {.segment = segment,
         .frame = painter_.paint(snapshot, view, has_note ? std::optional(director_.note(now)) : std::nullopt)});
    if (in_work_.size() > kMaxInWork) encode_oldest_frame();
  }
}

void Film::finish() {
  while (!in_work_.empty()) encode_oldest_frame();
  close_segment();
}

void Film::encode_oldest_frame() {
  FrameInWork oldest = std::move(in_work_.front());
  in_work_.pop_front();
  if (oldest.segment != open_segment_) {
    close_segment();
    video_ = std::make_unique<VideoWriter>(segments_.file(oldest.segment), settings_.width, settings_.height,
                                           frames_per_second_);
    open_segment_ = oldest.segment;
  }
  video_->add(oldest.frame.get());
}

void Film::close_segment() {
  if (video_) video_->finish();
  video_.reset();
}

}  // namespace patrol::render
