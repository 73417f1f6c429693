#include "services/serving/stop_signal.h"

#include <unistd.h>

#include <utility>

namespace spindrift {
namespace {

/// Returns whether the signal is ignored, e.g. because of `nohup`. Waiting for an ignored signal
/// would receive it nevertheless.
bool is_ignored(int signal) {
  struct sigaction action {};
  ::sigaction(signal, nullptr, &action);
  return action.sa_handler == SIG_IGN;
}

}  // namespace

StopSignal::StopSignal() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  if (!is_ignored(SIGHUP)) {
    sigaddset(&signals_, SIGHUP);
  }
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

StopSignal::~StopSignal() {
  if (thread_.joinable()) {
    raise();
    thread_.join();
  }
}

void StopSignal::on_stop(std::function<void()> stop) {
  thread_ = std::thread{[signals = signals_, stop = std::move(stop)] {
    int signal = 0;
    sigwait(&signals, &signal);
    stop();
  }};
}

void StopSignal::raise() { ::kill(::getpid(), SIGTERM); }

void StopSignal::join() { thread_.join(); }

}  // namespace spindrift
