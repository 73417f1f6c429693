/// @file
/// Answers requests of other programs to the holder of an archive.
///
/// The socket stands beside the archive as ARCHIVE.sock and only its user may open it. A caller is
/// refused when 16 others wait, and disconnected when its request has not come within five seconds
/// or is longer than a mebibyte. No caller holds up another one or the end of the server.

#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <list>
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
  /// Answers one request. An exception becomes the answer {"error": text}.
  using Answer = std::function<nlohmann::json(const nlohmann::json& request)>;
  /// Answers by the value of `do` in requests. Each has its own thread, which answers one request
  /// after the other, so that no request waits behind those for something else.
  using Answers = std::map<std::string, Answer>;

  /// @param archive Must be locked by us. @return Unavailable when the kernel refuses; the errors
  ///        of address_of.
  static Expected<std::unique_ptr<RequestServer>> start(const std::filesystem::path& archive,
                                                        const Answers& answers);
  /// Waits for answers in progress.
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
  /// The queue and thread for one value of `do`.
  class Counter {
   public:
    explicit Counter(Answer answer);
    ~Counter();
    Counter(const Counter&) = delete;
    Counter& operator=(const Counter&) = delete;
    Counter(Counter&&) = delete;
    Counter& operator=(Counter&&) = delete;

    /// Call it from one thread only. Refuses the request when too many are waiting.
    void queue(Asked asked);

   private:
    Answer answer_;
    BoundedQueue<Asked> waiting_;
    std::jthread thread_;  // Last member, since the thread uses the others.
  };

  RequestServer(std::filesystem::path path, Descriptor socket, Descriptor stop,
                const Answers& answers);
  /// A caller whose request has not come as a whole.
  struct Caller {
    Descriptor socket;
    std::chrono::steady_clock::time_point until;
    std::string line = {};
  };
  void run();
  void accept(std::list<Caller>& callers);
  bool hear(Caller& caller);
  void serve(Caller& caller);

  std::filesystem::path path_;
  Descriptor socket_;
  Descriptor stop_;  ///< Readable when the server has to stop.
  std::map<std::string, Counter> counters_;
  std::thread thread_;  // Last member, since the thread uses the others.
};

}  // namespace spindrift
