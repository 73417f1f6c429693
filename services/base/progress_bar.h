/// @file
/// How far a long command is, for somebody who watches it.

#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace spindrift {

/// Ahead of whatever else is written to a terminal while a bar may stand in its last line.
inline constexpr const char* kEraseLine = "\r\x1b[K";

/// `text` in place of what stands in the last line of standard error, a terminal; at once, which
/// the end of a line would do otherwise.
void draw_last_line(const std::string& text);

/// One line on standard error, drawn anew at most ten times a second and gone at the end. Silent
/// where standard error is no terminal.
class ProgressBar {
 public:
  /// @param label What is being done: "processing". @param total What `done` will reach.
  ProgressBar(std::string label, std::uint64_t total);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ProgressBar(ProgressBar&&) = delete;
  ProgressBar& operator=(ProgressBar&&) = delete;

  /// Cheap enough for every batch.
  void advance_to(std::uint64_t done);

 private:
  std::string label_;
  std::uint64_t total_;
  bool shown_;
  std::chrono::steady_clock::time_point next_drawing_;
};

}  // namespace spindrift
