#include "app/plan/route_picture.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "render/canvas.h"

namespace patrol::app {
namespace {

constexpr Color kPaper{255, 255, 255}, kUnknownGround{214, 216, 219}, kObstacle{22, 34, 48}, kInflated{233, 164, 136},
    kDear{252, 222, 170};
constexpr Color kRoute{20, 90, 214}, kWriting{40, 48, 58};
constexpr int kFooter_px = 74, kEdge_px = 16, kMinWidth_px = 720;
constexpr double kMaxWidth_px = 1600.0, kMaxHeight_px = 1000.0, kMaxCell_px = 24.0;

class Sheet {
 public:
  explicit Sheet(const RoutePicture& picture) : picture_(picture) {
    const GridGeometry& map = picture.occupancy.geometry();
    for (int row = 0; row < map.height; ++row) {
      for (int col = 0; col < map.width; ++col) {
        if (picture.occupancy.at({col, row}) != kUnknown) shown_.extend(map.center_of({col, row}));
      }
    }
    for (const Eigen::Vector2d& p_m : picture.line_m) shown_.extend(p_m);
    for (const RoutePicture::Mark& mark : picture.marks) shown_.extend(mark.p_m);
    shown_.min().array() -= 0.5 * map.resolution_m;
    shown_.max().array() += 0.5 * map.resolution_m;
    px_per_m_ = std::min(
        {kMaxWidth_px / shown_.sizes().x(), kMaxHeight_px / shown_.sizes().y(), kMaxCell_px / map.resolution_m});
    width_px_ = std::max(1, static_cast<int>(std::lround(px_per_m_ * shown_.sizes().x())));
    height_px_ = std::max(1, static_cast<int>(std::lround(px_per_m_ * shown_.sizes().y())));
    frame_ = render::Frame(std::max(width_px_, kMinWidth_px), height_px_ + kFooter_px, kPaper);
  }

  render::Frame draw() {
    draw_ground();
    draw_obstacles();
    draw_line();
    for (const RoutePicture::Mark& mark : picture_.marks) draw_mark(mark);
    draw_footer();
    return std::move(frame_);
  }

 private:
  Eigen::Vector2d pixel_of(const Eigen::Vector2d& p_m) const {
    return px_per_m_ * Eigen::Vector2d(p_m.x() - shown_.min().x(), shown_.max().y() - p_m.y());
  }

  Color ground_at(const Eigen::Vector2d& p_m) const {
    const Cell cell = picture_.costs.geometry().cell_at(p_m), seen = picture_.occupancy.geometry().cell_at(p_m);
    const bool is_unknown = !picture_.occupancy.contains(seen) || picture_.occupancy.at(seen) == kUnknown;
    const plan::Cost cost = picture_.costs.contains(cell) ? picture_.costs.at(cell) : plan::kLethalCost;
    if (is_unknown) return kUnknownGround;
    if (cost == plan::kLethalCost) return kInflated;
    return render::blend(kPaper, kDear, static_cast<double>(cost) / plan::kMaxPassableCost);
  }

  void draw_ground() {
    for (int y = 0; y < height_px_; ++y) {
      for (int x = 0; x < width_px_; ++x)
        frame_.at(x, y) =
            ground_at({shown_.min().x() + (x + 0.5) / px_per_m_, shown_.max().y() - (y + 0.5) / px_per_m_});
    }
  }

  /// Draws at least one pixel per obstacle, for any picture size.
  void draw_obstacles() {
    const GridGeometry& map = picture_.occupancy.geometry();
    const Eigen::Vector2d half_m = Eigen::Vector2d::Constant(0.5 * map.resolution_m);
    for (int row = 0; row < map.height; ++row) {
      for (int col = 0; col < map.width; ++col) {
        if (picture_.occupancy.at({col, row}) < 50) continue;
        const Eigen::Vector2d a = pixel_of(map.center_of({col, row}) - half_m),
                              b = pixel_of(map.center_of({col, row}) + half_m);
        const int left = static_cast<int>(std::lround(a.x())), top = static_cast<int>(std::lround(b.y()));
        for (int y = top; y < std::max(top + 1, static_cast<int>(std::lround(a.y()))); ++y) {
          for (int x = left; x < std::max(left + 1, static_cast<int>(std::lround(b.x()))); ++x) {
            if (x >= 0 && y >= 0 && x < width_px_ && y < height_px_) frame_.at(x, y) = kObstacle;
          }
        }
      }
    }
  }

  void draw_line() {
    const std::vector<Eigen::Vector2d>& line_m = picture_.line_m;
    for (std::size_t i = 1; i < line_m.size(); ++i)
      render::draw_line(frame_, pixel_of(line_m[i - 1]), pixel_of(line_m[i]), 2.4, {kRoute});
  }

  void draw_mark(const RoutePicture::Mark& mark) {
    const Eigen::Vector2d pixel = pixel_of(mark.p_m);
    render::draw_disc(frame_, pixel, 7.0, {kPaper});
    render::draw_disc(frame_, pixel, 5.0, {mark.color});
    const int width = small_.width_px(mark.text),
              left = std::clamp(static_cast<int>(pixel.x()) + 9, 0, std::max(0, width_px_ - width - 4));
    const int baseline = std::clamp(static_cast<int>(pixel.y()) - 6, small_.height_px() + 2,
                                    std::max(height_px_ - 4, small_.height_px() + 2));
    render::fill_rectangle(frame_, left - 2, baseline - small_.height_px(), width + 4, small_.height_px() + 3,
                           {kPaper, 0.8});
    small_.draw(frame_, left, baseline, mark.text, {mark.color});
  }

  void draw_footer() {
    render::fill_rectangle(frame_, 0, height_px_, frame_.width(), kFooter_px, {kPaper});
    const int top = height_px_, width = frame_.width() - 2 * kEdge_px;
    title_.draw(frame_, kEdge_px, top + 20, title_.fitted(picture_.title, width), {kWriting});
    small_.draw(frame_, kEdge_px, top + 40, small_.fitted(picture_.note, width), {kWriting});
    int left = kEdge_px;
    const auto add = [&](Color color, const char* text) {
      render::fill_rectangle(frame_, left, top + 51, 14, 12, {kWriting, 0.4});
      render::fill_rectangle(frame_, left + 1, top + 52, 12, 10, {color});
      left = small_.draw(frame_, left + 20, top + 62, text, {kWriting}) + 22;
    };
    add(kObstacle, "obstacle");
    add(kInflated, "lethal by inflation");
    add(kDear, "higher cost: near an obstacle, or unknown");
    add(kUnknownGround, "unknown");
    add(kRoute, "route");
  }

  const RoutePicture& picture_;
  Eigen::AlignedBox2d shown_;
  double px_per_m_ = 1.0;
  int width_px_ = 0, height_px_ = 0;
  render::Frame frame_;
  render::Font title_{15, true}, small_{12};
};

}  // namespace

render::Frame draw_route(const RoutePicture& picture) { return Sheet(picture).draw(); }

}  // namespace patrol::app
