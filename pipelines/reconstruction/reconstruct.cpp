#include "pipelines/reconstruction/reconstruct.h"

#include "pipelines/reconstruction/methods.h"
#include "pipelines/reconstruction/observations.h"

namespace spindrift {

Expected<Reconstruction> reconstruct(const ReconstructionRequest& request,
                                     ReconstructionMethod method) {
  const auto all = observations_of(request);
  if (!all) {
    return Unexpected{all.error()};
  }
  return method == ReconstructionMethod::Batch ? reconstruct_batch(request, *all)
                                               : reconstruct_sequential(request, *all);
}

}  // namespace spindrift
