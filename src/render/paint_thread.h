#pragma once

#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <thread>

#include "render/camera.h"
#include "render/frame.h"
#include "render/run_snapshot.h"
#include "sim/mujoco.h"

namespace patrol::render {

/// A thread that paints finished replay frames: world, smoothed edges, overlay. OpenGL belongs to one thread,
/// so each has its own context. What it paints depends on nothing but what it is given.
class PaintThread {
 public:
  /// Arguments as for ScenePainter. Waits until the thread has its OpenGL; throws what kept it from that. `view` must outlive
  /// the thread.
  PaintThread(const mjModel& view, int width, int height, double extinction_per_m);
  ~PaintThread();
  PaintThread(const PaintThread&) = delete;
  PaintThread& operator=(const PaintThread&) = delete;

  std::future<Frame> paint(RunSnapshot snapshot, const View& view);

 private:
  struct Order {
    RunSnapshot snapshot;
    View view;
    std::promise<Frame> frame;
  };
  void work(const mjModel& view, int width, int height, double extinction_per_m, std::promise<void> is_ready);
  /// False when there is nothing more to come.
  bool take(Order& order);

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Order> orders_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace patrol::render
