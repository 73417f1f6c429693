/// @file
/// Shows on a terminal how far a long command has come.

#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace spindrift {

/// Precedes any other output to a terminal whose last line may hold a progress bar.
inline constexpr const char* kEraseLine = "\r\x1b[K";

/// Replaces the last line of standard error, a terminal, by `text`, and flushes because no line end
/// does so.
void draw_last_line(const std::string& text);

/// One line on standard error, redrawn at most ten times a second and erased at the end. Draws
/// nothing where standard error is no terminal.
class ProgressBar {
 public:
  /// @param label Name of the activity, as "processing". @param total Final value of `done`.
  ProgressBar(std::string label, std::uint64_t total);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ProgressBar(ProgressBar&&) = delete;
  ProgressBar& operator=(ProgressBar&&) = delete;

  /// Draws only when due, so that it is cheap enough to call for every batch.
  void advance_to(std::uint64_t done);

 private:
  std::string label_;
  std::uint64_t total_;
  bool shown_;
  std::chrono::steady_clock::time_point next_drawing_;
};

}  // namespace spindrift
