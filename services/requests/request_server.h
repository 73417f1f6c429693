/// @file
/// Answering the programs that ask the holder of an archive.

#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "pipelines/core/expected.h"
#include "services/requests/request_socket.h"

namespace spindrift {

class RequestServer {
 public:
  /// Of one request, on the server's thread. What it throws is the answer {"error": text}.
  using Answer = std::function<nlohmann::json(const nlohmann::json& request)>;

  /// @param archive Whose lock is held. @return Unavailable when the kernel refuses; as address_of.
  static Expected<std::unique_ptr<RequestServer>> start(const std::filesystem::path& archive,
                                                        Answer answer);
  /// Waits for an answer that is being made.
  ~RequestServer();
  RequestServer(const RequestServer&) = delete;
  RequestServer& operator=(const RequestServer&) = delete;
  RequestServer(RequestServer&&) = delete;
  RequestServer& operator=(RequestServer&&) = delete;

 private:
  RequestServer(std::filesystem::path path, Descriptor socket, Descriptor stop, Answer answer);
  void run();
  void serve(const Descriptor& caller) const;

  std::filesystem::path path_;
  Descriptor socket_;
  Descriptor stop_;  ///< Readable: no more are answered.
  Answer answer_;
  std::thread thread_;  // Last: it uses the others.
};

}  // namespace spindrift
