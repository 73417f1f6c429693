#include "pipelines/frames/shortest_turn.h"

namespace spindrift {

// In a file of its own: Eigen's code for opposite directions takes ten seconds to compile.
Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace spindrift
