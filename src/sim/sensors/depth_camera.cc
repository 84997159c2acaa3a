#include "sim/sensors/depth_camera.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {
namespace {

constexpr double kDarkest = 0.02;  // minimum reflectivity of any surface

/// Returns the smaller of both differences, which is the slope of the pixel's own surface also next to an edge.
double smaller_difference(double before, double here, double after) {
  const double left = here - before, right = after - here;
  return std::abs(left) < std::abs(right) ? left : right;
}

}  // namespace

PinholeLens make_lens(const DepthCameraSettings& settings) {
  return {.width_px = settings.width_px,
          .height_px = settings.height_px,
          .focal_px = 0.5 * settings.width_px / std::tan(0.5 * settings.fov_deg * kDegree)};
}

DepthCamera::DepthCamera(const DepthCameraSettings& settings, const DustSettings& dust,
                         std::unique_ptr<DepthImager> imager, std::uint64_t seed, const DepthCameraErrors& errors)
    : settings_(settings),
      dust_(dust),
      errors_(errors),
      lens_(make_lens(settings)),
      imager_(std::move(imager)),
      noise_(seed, "depth_camera/noise"),
      edge_(seed, "depth_camera/edge"),
      dropout_(seed, "depth_camera/dropout") {
  validate(settings, "sensors.depth_camera");
}

// The inverse depth of a plane is linear over the image, so slopes and edges are computed from it.
void DepthCamera::compute_inverse_depth() {
  inverse_depth_.resize(ideal_.depth_m.size());
  std::transform(ideal_.depth_m.begin(), ideal_.depth_m.end(), inverse_depth_.begin(),
                 [](float depth_m) { return std::isfinite(depth_m) ? 1.0 / static_cast<double>(depth_m) : 0.0; });
}

/// Returns whether a pixel further right occludes the point in the right imager. A pixel is shifted left in that imager
/// by its disparity, focal length x baseline / depth.
bool DepthCamera::is_occluded_in_right_imager(int u, int v) const {
  const double disparity_px_m = lens_.focal_px * settings_.baseline_m;
  const auto max_shift = static_cast<int>(disparity_px_m / settings_.range_min_m);
  for (int k = 1; k <= max_shift && u + k < lens_.width_px; ++k) {
    if (disparity_px_m * (inverse_depth(u + k, v) - inverse_depth(u, v)) >= k) return true;
  }
  return false;
}

bool DepthCamera::is_at_edge(int u, int v) const {
  const double here = inverse_depth(u, v);
  const auto bends = [&](double before, double after) {
    return std::abs(before - 2.0 * here + after) > settings_.edge_threshold * here;
  };
  return (u > 0 && u + 1 < lens_.width_px && bends(inverse_depth(u - 1, v), inverse_depth(u + 1, v))) ||
         (v > 0 && v + 1 < lens_.height_px && bends(inverse_depth(u, v - 1), inverse_depth(u, v + 1)));
}

/// Returns the cosine of the angle between the line of sight and the surface normal.
///
/// On the plane n . X = 1 with X = z (a, b, 1) the inverse depth is n . (a, b, 1); its slopes over the image give n.
double DepthCamera::incidence_cosine(int u, int v) const {
  const double here = inverse_depth(u, v);
  const int left = std::max(u - 1, 0), right = std::min(u + 1, lens_.width_px - 1);
  const int up = std::max(v - 1, 0), down = std::min(v + 1, lens_.height_px - 1);
  const Eigen::Vector3d ray((u - lens_.cx_px()) / lens_.focal_px, (v - lens_.cy_px()) / lens_.focal_px, 1.0);
  Eigen::Vector3d n(lens_.focal_px * (left == u || right == u
                                          ? inverse_depth(right, v) - inverse_depth(left, v)
                                          : smaller_difference(inverse_depth(left, v), here, inverse_depth(right, v))),
                    lens_.focal_px * (up == v || down == v
                                          ? inverse_depth(u, down) - inverse_depth(u, up)
                                          : smaller_difference(inverse_depth(u, up), here, inverse_depth(u, down))),
                    0.0);
  n.z() = here - n.dot(ray);
  return here / (n.norm() * ray.norm());
}

/// Returns whether enough of the pattern returns and both imagers observe it.
bool DepthCamera::is_visible(int u, int v) const {
  if (is_occluded_in_right_imager(u, v)) return false;
  const double cosine = incidence_cosine(u, v);
  if (cosine < std::cos(settings_.max_incidence_deg * kDegree)) return false;
  const double reflectivity = std::max(kDarkest, static_cast<double>(ideal_.reflectivity[index_of(u, v)]));
  // as in lidar.cc
  const double reach_m = settings_.max_range_10pct_m * std::sqrt(reflectivity * std::sqrt(cosine) / 0.1);
  return dust_.equivalent_clear_distance_m(static_cast<double>(ideal_.depth_m[index_of(u, v)])) <= reach_m;
}

DepthImage DepthCamera::take(const BodyPoses& bodies, const Pose3& T_world_camera, Time now, std::uint64_t tick) {
  imager_->draw(bodies, T_world_camera, ideal_);
  compute_inverse_depth();
  DepthImage image{.stamp = now,
                   .width = lens_.width_px,
                   .height = lens_.height_px,
                   .fx_px = lens_.focal_px * errors_.focal_scale,
                   .fy_px = lens_.focal_px * errors_.focal_scale,
                   .cx_px = lens_.cx_px() + errors_.cx_px,
                   .cy_px = lens_.cy_px() + errors_.cy_px,
                   .depth_mm = std::vector<std::uint16_t>(ideal_.depth_m.size(), 0)};
  for (int v = 0; v < lens_.height_px; ++v) {
    for (int u = 0; u < lens_.width_px; ++u) {
      const std::size_t pixel = index_of(u, v);
      const auto true_m = static_cast<double>(ideal_.depth_m[pixel]);
      if (!(true_m <= settings_.range_max_m) || !is_visible(u, v)) continue;
      if (dropout_.uniform(tick, pixel) < settings_.dropout_probability) continue;
      if (is_at_edge(u, v) && edge_.uniform(tick, pixel) < settings_.edge_dropout_probability) continue;
      const double std_m =
          settings_.depth_noise_std_per_m * true_m * true_m * std::exp(2.0 * dust_.extinction_per_m() * true_m);
      const double measured_m = true_m / (1.0 + errors_.inverse_depth_per_m * true_m);
      const double depth_m = measured_m + std_m * noise_.normal(tick, pixel);
      if (depth_m < settings_.range_min_m || depth_m > settings_.range_max_m) continue;
      image.depth_mm[pixel] = static_cast<std::uint16_t>(std::lround(1000.0 * depth_m));
    }
  }
  return image;
}

namespace {

/// Depth camera whose images the worker computes while they are in transit. Its imager lives in the worker's thread.
class DepthCameraOnBody : public PeriodicSensor {
 public:
  DepthCameraOnBody(const SensorContext& context, const DepthCameraSettings& settings)
      : PeriodicSensor(settings.rate_hz),
        T_body_camera_(context.robot.T_body("depth_camera")),
        worker_(context.worker) {
    constexpr double kNear_m = 0.05;  // minimum distance; closer surfaces belong to the housing
    worker_.run([&] {
      camera_.emplace(settings, context.settings.dust,
                      context.make_depth_imager(context.view, make_lens(settings), kNear_m, 1.1 * settings.range_max_m),
                      context.seed, context.as_built.depth_camera());
    });
  }
  ~DepthCameraOnBody() override {
    try {
      worker_.run([this] { camera_.reset(); });
    } catch (...) {  // the run ends with the error that `complete` has thrown
    }
  }
  DepthCameraOnBody(const DepthCameraOnBody&) = delete;
  DepthCameraOnBody& operator=(const DepthCameraOnBody&) = delete;

  void complete(SensorMessage& reading) override {
    worker_.wait(pending_.front().ticket);
    reading = std::move(*pending_.front().image);
    pending_.pop_front();
  }

 private:
  struct Pending {
    BackgroundWorker::Ticket ticket;
    std::shared_ptr<DepthImage> image;
  };

  void read(const SensorTick& tick, std::uint64_t index, std::vector<SensorMessage>& readings) override {
    const auto timer = tick.clock.time_stage("depth_camera");
    const auto image = std::make_shared<DepthImage>();
    const auto take = [this, image, bodies = BodyPoses(tick.physics, tick.data),
                       T_world_camera = tick.T_world_body * T_body_camera_, now = tick.now,
                       index] { *image = camera_->take(bodies, T_world_camera, now, index); };
    pending_.push_back({worker_.submit(take), image});
    readings.emplace_back(DepthImage{.stamp = tick.now, .depth_mm = {}});
  }

  Pose3 T_body_camera_;
  BackgroundWorker& worker_;
  std::optional<DepthCamera> camera_;
  std::deque<Pending> pending_;  ///< images to be completed, in order
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<DepthImage>(const SensorContext& context) {
  const DepthCameraSettings& settings = context.settings.depth_camera;
  if (!settings.enabled) return nullptr;
  validate(settings, "sensors.depth_camera");
  context.robot.T_body("depth_camera");  // throws if the robot has no such frame
  if (!context.make_depth_imager)
    throw InputError("sensors.depth_camera.enabled = true: requires a renderer, which this command lacks");
  return std::make_unique<DepthCameraOnBody>(context, settings);
}

}  // namespace patrol::sim
