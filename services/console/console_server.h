/// @file
/// The console over HTTP, on threads of its own that give way to others.

#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/console/console_answers.h"

namespace spindrift {

struct ConsoleOptions {
  std::string address;  ///< HOST:PORT, a numeric host or localhost; 127.0.0.1 where there is none.
                        ///< Port 0: a free one.
  std::vector<std::string> names;  ///< By which browsers may call it, beside it and localhost.
  std::filesystem::path db;
};

class ConsoleServer {
 public:
  /// @return InvalidConfiguration for an address that is none.
  static Expected<void> check(const std::string& address);
  /// @param service Outlives it.
  /// @return As `check`; Unavailable where it cannot listen;
  ///         as token_of.
  static Expected<std::unique_ptr<ConsoleServer>> start(const ConsoleOptions& options,
                                                        const ConsoleAnswers::Service& service);
  /// Drops the viewers; waits for an answer that is being made.
  ~ConsoleServer();
  ConsoleServer(const ConsoleServer&) = delete;
  ConsoleServer& operator=(const ConsoleServer&) = delete;
  ConsoleServer(ConsoleServer&&) = delete;
  ConsoleServer& operator=(ConsoleServer&&) = delete;

  /// http://HOST:PORT/
  const std::string& url() const { return url_; }

 private:
  class Loop;
  ConsoleServer(std::string url, std::unique_ptr<Loop> loop);

  std::string url_;
  std::unique_ptr<Loop> loop_;
};

}  // namespace spindrift
