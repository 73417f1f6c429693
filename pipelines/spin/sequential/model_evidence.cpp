#include "pipelines/spin/sequential/model_evidence.h"

namespace spindrift {
namespace {

// Evidence from before a restart keeps the weight of this many edges.
constexpr double kFadedEdges = 100.0;

}  // namespace

void ModelEvidence::add(const ErrorInformation& errors, double edges) {
  edges_ += edges;
  errors_ += errors;
}

void ModelEvidence::fade() {
  const double share = edges_ > kFadedEdges ? kFadedEdges / edges_ : 1.0;
  edges_ *= share;
  errors_ *= share;
}

}  // namespace spindrift
