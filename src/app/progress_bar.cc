#include "app/progress_bar.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>

#include <fmt/format.h>

namespace patrol::app {
namespace {

// A signal handler can reach nothing but a global.
volatile std::sig_atomic_t interrupts = 0;

void count_interrupt(int signal) {
  interrupts = interrupts + 1;
  if (interrupts > 1) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

ProgressBar::ProgressBar() : is_terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (has_drawn_) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::show(const std::string& line) {
  if (!is_terminal_) return;
  fmt::print(stderr, "\r\033[K{}", line);
  std::fflush(stderr);
  has_drawn_ = true;
}

void ProgressBar::say(const std::string& line) {
  fmt::print(stderr, "{}{}\n", has_drawn_ ? "\r\033[K" : "", line);
  has_drawn_ = false;
}

InterruptGuard::InterruptGuard() {
  interrupts = 0;
  std::signal(SIGINT, count_interrupt);
  std::signal(SIGTERM, count_interrupt);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool InterruptGuard::is_interrupted() const { return interrupts > 0; }

}  // namespace patrol::app
