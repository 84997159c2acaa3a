#include "app/common/progress_bar.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace patrol::app {
namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a signal handler has no other access
volatile std::sig_atomic_t interrupts = 0;

constexpr int kCounted[] = {SIGINT, SIGTERM, SIGHUP};

void count_interrupt(int signal) {
  interrupts = interrupts + 1;
  if (interrupts > 1) {
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

void ProgressBar::print_line(const std::string& line) {
  write((is_shown_ ? kClear : "") + line + "\n");
  is_shown_ = false;
}

InterruptGuard::InterruptGuard() {
  interrupts = 0;
  for (const int signal : kCounted) {
    // nohup ignores SIGHUP so that a program outlives its terminal.
    if (std::signal(signal, count_interrupt) == SIG_IGN && signal == SIGHUP) std::signal(signal, SIG_IGN);
  }
}

InterruptGuard::~InterruptGuard() {
  for (const int signal : kCounted) {
    if (std::signal(signal, SIG_DFL) == SIG_IGN && signal == SIGHUP) std::signal(signal, SIG_IGN);
  }
}

// NOLINTNEXTLINE(readability-convert-member-functions-to-static): interrupts are counted only while a guard exists
bool InterruptGuard::is_interrupted() const { return interrupts > 0; }

}  // namespace patrol::app
