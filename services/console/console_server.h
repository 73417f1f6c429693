/// @file
/// Serves the console over HTTP, on low-priority threads.

#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/console/console_answers.h"

namespace spindrift {

struct ConsoleOptions {
  /// HOST:PORT with a numeric host or localhost (default 127.0.0.1); port 0 takes a free one.
  std::string address;
  std::vector<std::string> names;  ///< Further host names for browsers.
  std::filesystem::path db;
};

class ConsoleServer {
 public:
  /// @return InvalidConfiguration for a malformed address.
  static Expected<void> check(const std::string& address);
  /// @param service Must outlive the server.
  /// @return The errors of `check` and token_of; Unavailable where it cannot listen.
  static Expected<std::unique_ptr<ConsoleServer>> start(const ConsoleOptions& options,
                                                        const ConsoleAnswers::Service& service);
  /// Disconnects the viewers; waits for an answer that is being made.
  ~ConsoleServer();
  ConsoleServer(const ConsoleServer&) = delete;
  ConsoleServer& operator=(const ConsoleServer&) = delete;
  ConsoleServer(ConsoleServer&&) = delete;
  ConsoleServer& operator=(ConsoleServer&&) = delete;

  /// Returns http://HOST:PORT/ with the actual port.
  const std::string& url() const { return url_; }

 private:
  class Loop;
  ConsoleServer(std::string url, std::unique_ptr<Loop> loop);

  std::string url_;
  std::unique_ptr<Loop> loop_;
};

}  // namespace spindrift
