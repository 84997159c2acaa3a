#include "app/run/terminal_view.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

#include "core/error.h"
#include "core/overloaded.h"

namespace patrol::app {
namespace {

constexpr std::size_t kKeptEvents = 16;
constexpr double kDrivenSpacing_m = 0.1;
constexpr std::chrono::milliseconds kFramePeriod{100};

winsize terminal_size() {
  winsize size{};
  const bool is_known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0;
  return is_known ? size : winsize{.ws_row = 24, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
}

}  // namespace

TerminalView::TerminalView(const std::string& name) {
  if (::isatty(STDOUT_FILENO) != 1) throw InputError("--watch: standard output must be a terminal");
  run_.name = name;
  fmt::print("\033[?1049h\033[?25l\033[2J");  // alternate screen, hidden cursor
}

TerminalView::~TerminalView() { restore_screen(); }

void TerminalView::end_simulation() {
  restore_screen();
  interrupt_.release();
}

void TerminalView::restore_screen() {
  if (!is_shown_) return;
  is_shown_ = false;
  fmt::print("\033[?25h\033[?1049l");
  std::fflush(stdout);
}

void TerminalView::begin(const ScenarioFiles& files) {
  if (!files.map) return;
  run_.map = *files.map;
  T_world_map_ = files.T_site_map();
}

void TerminalView::on_message(const stack::StackMessage& message) {
  std::visit(Overloaded{
                 [&](const PoseEstimate& estimate) {
                   run_.estimate = estimate;
                   if (!T_world_map_ && T_world_body_) T_world_map_ = *T_world_body_ * estimate.T_map_body.inverse();
                   const Eigen::Vector2d p_m = estimate.T_map_body.position();
                   if (run_.traveled_m.empty() || (p_m - run_.traveled_m.back()).norm() > kDrivenSpacing_m)
                     run_.traveled_m.push_back(p_m);
                 },
                 [&](const MapUpdate& update) { run_.map = update.map; },
                 [&](const Path& path) { run_.path = path.T_map_body; },
                 [&](const LocalizationConfidence& confidence) { run_.confidence = confidence; },
                 [&](const VelocityCommand& command) { run_.command = command; },
                 [&](const Event& event) {
                   run_.events.push_back(event);
                   if (run_.events.size() > kKeptEvents) run_.events.pop_front();
                 },
                 [](const auto&) {},
             },
             message);
}

void TerminalView::on_ground_truth(const GroundTruth& truth) { T_world_body_ = to_pose2(truth.T_world_body); }

bool TerminalView::keep_running(Time now, double distance_m) {
  const auto wall = std::chrono::steady_clock::now();
  if (wall - last_frame_ < kFramePeriod) return !interrupt_.is_interrupted();
  last_frame_ = wall;
  run_.now = now;
  run_.distance_m = distance_m;
  run_.real_time_factor = to_seconds(now) / std::max(1e-3, std::chrono::duration<double>(wall - begin_).count());
  if (T_world_map_ && T_world_body_) run_.truth = T_world_map_->inverse() * *T_world_body_;
  const winsize size = terminal_size();
  fmt::print("\033[H{}", render_run_view(run_, size.ws_col, size.ws_row));
  std::fflush(stdout);
  return !interrupt_.is_interrupted();
}

}  // namespace patrol::app
