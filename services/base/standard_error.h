/// @file
/// A standard error stream that never blocks the writer.
///
/// spdlog's asynchronous logger was rejected: it joins its thread at the end, however long a write
/// takes.

#pragma once

#include <sys/types.h>

#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>

namespace spindrift {

/// Replaces `stderr` for the log, all other messages and the libraries. Up to a mebibyte is
/// buffered for a thread that writes it out. Further messages are dropped, and their number is
/// reported in their place.
class StandardError {
 public:
  /// Call it before any other thread is started.
  StandardError();
  ~StandardError();
  StandardError(const StandardError&) = delete;
  StandardError& operator=(const StandardError&) = delete;
  StandardError(StandardError&&) = delete;
  StandardError& operator=(StandardError&&) = delete;

  /// Waits briefly for the buffered text to be written. Call it after all other threads have ended.
  /// @return False when nobody reads the stream. The thread then stays blocked and uses this
  ///         object, so that the process has to end by `_exit`.
  [[nodiscard]] bool close();

 private:
  static ssize_t write(void* self, const char* text, std::size_t size);
  void run();

  std::FILE* const real_;
  std::FILE* stream_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::string waiting_;
  std::size_t dropped_ = 0;  ///< Messages dropped after `waiting_`.
  bool closed_ = false;
  bool out_ = false;  ///< The thread has written everything and ended.

  std::thread thread_;  // Last member, since the thread uses the others.
};

}  // namespace spindrift
