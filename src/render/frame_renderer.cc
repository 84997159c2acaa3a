#include "render/frame_renderer.h"

#include <memory>
#include <utility>

#include "render/overlay.h"
#include "render/scene/antialias.h"
#include "render/scene/scene_painter.h"

namespace patrol::render {
namespace {

/// Creates a thread's resources and reports success or the error through `is_ready`. Null on failure.
template <typename Make>
auto create_or_report(std::promise<void>& is_ready, Make make) -> decltype(make()) {
  try {
    auto made = make();
    is_ready.set_value();
    return made;
  } catch (...) {
    is_ready.set_exception(std::current_exception());
    return nullptr;
  }
}

}  // namespace

FrameRenderer::FrameRenderer(const mjModel& view, const FrameSettings& settings) {
  std::promise<void> can_draw, can_finish;
  std::future<void> readiness[] = {can_draw.get_future(), can_finish.get_future()};
  world_thread_ = std::thread([this, &view, settings, ready = std::move(can_draw)]() mutable {
    run_world_thread(view, settings, std::move(ready));
  });
  overlay_thread_ = std::thread(
      [this, settings, ready = std::move(can_finish)]() mutable { run_overlay_thread(settings, std::move(ready)); });
  try {
    for (std::future<void>& ready : readiness) ready.get();
  } catch (...) {
    stop();
    throw;
  }
}

FrameRenderer::~FrameRenderer() { stop(); }

void FrameRenderer::stop() {
  queued_.close();
  drawn_.close();
  world_thread_.join();
  overlay_thread_.join();
}

std::future<Frame> FrameRenderer::paint(RunSnapshot snapshot, const View& view, std::optional<FilmNote> note) {
  FrameRequest order{
      .snapshot = std::move(snapshot), .view = view, .note = std::move(note), .frame = {}, .depth = {}, .result = {}};
  std::future<Frame> frame = order.result.get_future();
  queued_.put(std::move(order));
  return frame;
}

void FrameRenderer::run_world_thread(const mjModel& view, const FrameSettings& settings, std::promise<void> is_ready) {
  const auto painter = create_or_report(is_ready, [&] {
    return std::make_unique<SceneRenderer>(view, settings.width, settings.height, settings.extinction_per_m,
                                           settings.renderer);
  });
  if (!painter) return;
  while (std::optional<FrameRequest> order = queued_.take()) {
    try {
      painter->set_state(order->snapshot.state);
      painter->set_estimate(order->snapshot.T_true_estimate.value_or(Pose2{}));
      painter->draw(order->view, order->frame, order->depth);
      drawn_.put(std::move(*order));
    } catch (...) {
      order->result.set_exception(std::current_exception());
    }
  }
}

void FrameRenderer::run_overlay_thread(const FrameSettings& settings, std::promise<void> is_ready) {
  const auto overlay =
      create_or_report(is_ready, [&] { return std::make_unique<Overlay>(settings.height, settings.gas); });
  if (!overlay) return;
  while (std::optional<FrameRequest> order = drawn_.take()) {
    try {
      smooth_edges(order->frame);
      overlay->draw(order->frame, order->depth, order->view, order->snapshot, order->note);
      order->result.set_value(std::move(order->frame));
    } catch (...) {
      order->result.set_exception(std::current_exception());
    }
  }
}

}  // namespace patrol::render
