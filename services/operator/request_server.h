/// @file
/// Answering the programs that ask the holder of an archive.

#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "pipelines/core/expected.h"
#include "services/base/bounded_queue.h"
#include "services/operator/request_socket.h"

namespace spindrift {

class RequestServer {
 public:
  /// Of one request. What it throws is the answer {"error": text}.
  using Answer = std::function<nlohmann::json(const nlohmann::json& request)>;
  /// By what requests say in `do`. Each kind has a thread of its own, on which they are answered
  /// one after the other: nobody waits behind those who ask for something else.
  using Answers = std::map<std::string, Answer>;

  /// @param archive Whose lock is held. @return Unavailable when the kernel refuses; as address_of.
  static Expected<std::unique_ptr<RequestServer>> start(const std::filesystem::path& archive,
                                                        const Answers& answers);
  /// Waits for the answers that are being made.
  ~RequestServer();
  RequestServer(const RequestServer&) = delete;
  RequestServer& operator=(const RequestServer&) = delete;
  RequestServer(RequestServer&&) = delete;
  RequestServer& operator=(RequestServer&&) = delete;

 private:
  struct Asked {
    Descriptor caller;
    nlohmann::json request;
  };
  /// Those who ask for one thing.
  class Counter {
   public:
    explicit Counter(Answer answer);
    ~Counter();
    Counter(const Counter&) = delete;
    Counter& operator=(const Counter&) = delete;
    Counter(Counter&&) = delete;
    Counter& operator=(Counter&&) = delete;

    /// Of one thread. Who finds too many waiting is told so.
    void queue(Asked asked);

   private:
    Answer answer_;
    BoundedQueue<Asked> waiting_;
    std::jthread thread_;  // Last: it uses the others.
  };

  RequestServer(std::filesystem::path path, Descriptor socket, Descriptor stop,
                const Answers& answers);
  void run();
  void serve(Descriptor caller);

  std::filesystem::path path_;
  Descriptor socket_;
  Descriptor stop_;  ///< Readable: no more are answered.
  std::map<std::string, Counter> counters_;
  std::thread thread_;  // Last: it uses the others.
};

}  // namespace spindrift
