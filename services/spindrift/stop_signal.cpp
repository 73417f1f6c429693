#include "services/spindrift/stop_signal.h"

#include <unistd.h>

#include <utility>

namespace spindrift {

StopSignal::StopSignal() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
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
