#include "render/paint_thread.h"

#include <utility>
#include <vector>

#include "render/antialias.h"
#include "render/overlay.h"
#include "render/scene_painter.h"

namespace patrol::render {

PaintThread::PaintThread(const mjModel& view, int width, int height, double extinction_per_m) {
  std::promise<void> is_ready;
  std::future<void> readiness = is_ready.get_future();
  thread_ = std::thread([this, &view, width, height, extinction_per_m, ready = std::move(is_ready)]() mutable {
    work(view, width, height, extinction_per_m, std::move(ready));
  });
  try {
    readiness.get();
  } catch (...) {
    thread_.join();
    throw;
  }
}

PaintThread::~PaintThread() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

std::future<Frame> PaintThread::paint(RunSnapshot snapshot, const View& view) {
  Order order{.snapshot = std::move(snapshot), .view = view, .frame = {}};
  std::future<Frame> frame = order.frame.get_future();
  {
    const std::lock_guard lock(mutex_);
    orders_.push_back(std::move(order));
  }
  wake_.notify_all();
  return frame;
}

bool PaintThread::take(Order& order) {
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [this] { return is_over_ || !orders_.empty(); });
  if (orders_.empty() || is_over_) return false;
  order = std::move(orders_.front());
  orders_.pop_front();
  return true;
}

void PaintThread::work(const mjModel& view, int width, int height, double extinction_per_m, std::promise<void> is_ready) {
  std::unique_ptr<ScenePainter> painter;
  std::unique_ptr<Overlay> overlay;
  try {
    painter = std::make_unique<ScenePainter>(view, width, height, extinction_per_m);
    overlay = std::make_unique<Overlay>(height);
  } catch (...) {
    is_ready.set_exception(std::current_exception());
    return;
  }
  is_ready.set_value();

  std::vector<float> depth;
  for (Order order; take(order);) {
    try {
      Frame frame;
      painter->set_state(order.snapshot.state);
      painter->draw(order.view, frame, depth);
      smooth_edges(frame);
      overlay->draw(frame, depth, order.view, order.snapshot);
      order.frame.set_value(std::move(frame));
    } catch (...) {
      order.frame.set_exception(std::current_exception());
    }
  }
}

}  // namespace patrol::render
