#include "services/base/standard_error.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <string_view>
#include <utility>

namespace spindrift {
namespace {

constexpr std::size_t kMostWaiting = std::size_t{1} << 20U;
constexpr std::size_t kLongestLine = 8192;
constexpr std::chrono::seconds kPatience{2};

/// Ignores errors, since a failure of standard error cannot be reported anywhere.
void write_all(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      return;
    }
  }
}

/// Starts a thread with all signals blocked, since other threads wait for them.
template <class Work>
std::thread thread_without_signals(Work work) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread{std::move(work)};
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace

StandardError::StandardError()
    : real_{stderr},
      stream_{fopencookie(this, "w", {nullptr, &StandardError::write, nullptr, nullptr})} {
  waiting_.reserve(kMostWaiting);  // Taking a message must not fail for lack of memory.
  std::setvbuf(stream_, nullptr, _IOLBF, kLongestLine);
  thread_ = thread_without_signals([this] { run(); });
  stderr = stream_;
}

StandardError::~StandardError() {
  if (out_) {
    std::fclose(stream_);
  }
}

bool StandardError::close() {
  std::fflush(stream_);
  std::unique_lock lock{mutex_};
  closed_ = true;
  changed_.notify_all();
  changed_.wait_for(lock, kPatience, [this] { return out_; });
  stderr = real_;
  if (!out_) {
    thread_.detach();
    return false;
  }
  lock.unlock();
  thread_.join();
  return true;
}

ssize_t StandardError::write(void* self, const char* text, std::size_t size) {
  auto& me = *static_cast<StandardError*>(self);
  {
    const std::lock_guard lock{me.mutex_};
    if (me.waiting_.size() + size <= kMostWaiting && me.dropped_ == 0) {
      me.waiting_.append(text, size);
    } else {
      ++me.dropped_;
    }
  }
  me.changed_.notify_all();
  return static_cast<ssize_t>(size);
}

void StandardError::run() {
  std::string taken;
  taken.reserve(kMostWaiting);
  std::unique_lock lock{mutex_};
  const auto is_work = [this] { return !waiting_.empty() || dropped_ > 0; };
  while (!closed_ || is_work()) {
    changed_.wait(lock, [&] { return closed_ || is_work(); });
    taken.swap(waiting_);
    const std::size_t dropped = std::exchange(dropped_, 0);
    lock.unlock();
    write_all(taken);
    if (dropped > 0) {
      write_all(fmt::format("{} messages were dropped here: nobody read them\n", dropped));
    }
    taken.clear();
    lock.lock();
  }
  out_ = true;
  changed_.notify_all();
}

}  // namespace spindrift
