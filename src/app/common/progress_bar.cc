#include "app/common/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>

#include <fmt/format.h>

namespace patrol::app {
namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a signal handler has no other access
std::atomic<int> interrupts = 0;  // lock-free: also written by a signal handler

constexpr int kCounted[] = {SIGINT, SIGTERM, SIGHUP};

void count_interrupt(int signal) {
  if (++interrupts > 1) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

const std::string kClear = "\r\033[K";

/// Writes to standard error. Does not throw if its terminal is closed: the command continues.
void write(const std::string& text) { std::fputs(text.c_str(), stderr); }

}  // namespace

ProgressBar::ProgressBar() : is_terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (is_shown_) write(kClear);
}

void ProgressBar::show(const std::string& line) {
  if (!is_terminal_) return;
  write(kClear + line);
  std::fflush(stderr);
  is_shown_ = true;
}

void ProgressBar::show(const std::string& line, double fraction, const std::string& qualifier) {
  const auto now = std::chrono::steady_clock::now();
  if (is_shown_ && now - last_shown_ < std::chrono::milliseconds(100)) return;
  last_shown_ = now;
  const std::string remaining = remaining_text(std::chrono::duration<double>(now - begin_).count(), fraction);
  show(remaining.empty() ? line : fmt::format("{}, {}{}", line, qualifier, remaining));
}

void ProgressBar::print_line(const std::string& line) {
  write((is_shown_ ? kClear : "") + line + "\n");
  is_shown_ = false;
}

std::string remaining_text(double elapsed_s, double fraction) {
  if (elapsed_s < 1.0 || !(fraction > 0.0) || fraction >= 1.0) return "";
  const double left_s = elapsed_s * (1.0 - fraction) / fraction;
  if (left_s < 90.0) return fmt::format("{:.0f} s left", std::ceil(left_s));
  const auto left_min = static_cast<int>(std::min(std::ceil(left_s / 60.0), 1e6));
  if (left_min < 90) return fmt::format("{} min left", left_min);
  return fmt::format("{} h {} min left", left_min / 60, left_min % 60);
}

InterruptGuard::InterruptGuard() {
  interrupts = 0;
  for (const int signal : kCounted) {
    // nohup ignores SIGHUP so that a program outlives its terminal.
    if (std::signal(signal, count_interrupt) == SIG_IGN && signal == SIGHUP) std::signal(signal, SIG_IGN);
  }
}

InterruptGuard::~InterruptGuard() { release(); }

void InterruptGuard::release() {
  if (is_released_) return;
  is_released_ = true;
  for (const int signal : kCounted) {
    if (std::signal(signal, SIG_DFL) == SIG_IGN && signal == SIGHUP) std::signal(signal, SIG_IGN);
  }
}

// NOLINTNEXTLINE(readability-convert-member-functions-to-static): interrupts are counted only while a guard exists
bool InterruptGuard::is_interrupted() const { return interrupts > 0; }

}  // namespace patrol::app
