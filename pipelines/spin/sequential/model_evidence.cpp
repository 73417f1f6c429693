#include "pipelines/spin/sequential/model_evidence.h"

namespace spindrift {
namespace {

// What was said before a restart weighs as much as so many edges.
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
