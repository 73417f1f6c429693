#include "services/base/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace spindrift {
namespace {

constexpr std::chrono::milliseconds kBetweenDrawings{100};
constexpr int kWidth = 30;

}  // namespace

void draw_last_line(const std::string& text) {
  fmt::print(stderr, "{}{}", kEraseLine, text);
  std::fflush(stderr);
}

ProgressBar::ProgressBar(std::string label, std::uint64_t total)
    : label_{std::move(label)}, total_{total}, shown_{total > 0 && isatty(STDERR_FILENO) == 1} {}

ProgressBar::~ProgressBar() {
  if (shown_) {
    draw_last_line("");
  }
}

void ProgressBar::advance_to(std::uint64_t done) {
  if (!shown_) {
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now < next_drawing_) {
    return;
  }
  next_drawing_ = now + kBetweenDrawings;
  const double part = static_cast<double>(std::min(done, total_)) / static_cast<double>(total_);
  const auto filled = static_cast<int>(part * kWidth);
  draw_last_line(fmt::format("{} [{:#>{}}{:->{}}] {:3.0f} %", label_, "", filled, "",
                             kWidth - filled, 100.0 * part));
}

}  // namespace spindrift
