#include "services/serving/kept_connection.h"

#include <sys/stat.h>

namespace spindrift {

Expected<void> KeptConnection::follow() {
  struct stat status {};
  const bool is_there = ::stat(path_.c_str(), &status) == 0;
  const Identity now{status.st_dev, status.st_ino};
  if (database_ && is_there && now == file_) {
    return {};
  }
  database_.reset();
  auto opened = open_for_reading(path_);
  if (!opened) {
    return Unexpected{opened.error()};
  }
  database_.emplace(*std::move(opened));
  file_ = now;
  return {};
}

}  // namespace spindrift
