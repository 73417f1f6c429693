/// @file
/// Standard error that nobody waits for.

#pragma once

#include <sys/types.h>

#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>

namespace spindrift {

/// Takes the place of `stderr`, for the log, for all other messages and for the libraries: what is
/// written waits, a mebibyte at most, for a thread that writes it. Beyond that messages are dropped
/// and counted, and the count is said where they are missing.
class StandardError {
 public:
  /// Before any other thread.
  StandardError();
  ~StandardError();
  StandardError(const StandardError&) = delete;
  StandardError& operator=(const StandardError&) = delete;
  StandardError(StandardError&&) = delete;
  StandardError& operator=(StandardError&&) = delete;

  /// After all other threads: waits for what is written to be out, but not long.
  /// @return false when nobody reads it. Its thread then waits for ever, and uses this: the process
  /// has to end by `_exit`.
  [[nodiscard]] bool close();

 private:
  static ssize_t take(void* self, const char* text, std::size_t size);
  void run();

  std::FILE* const real_;
  std::FILE* stream_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::string waiting_;
  std::size_t dropped_ = 0;  ///< Messages, after `waiting_`.
  bool closed_ = false;
  bool out_ = false;  ///< The thread has written all and ended.

  std::thread thread_;  // Last: it uses the others.
};

}  // namespace spindrift
