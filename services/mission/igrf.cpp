#include "services/mission/igrf.h"

#include "pipelines/geomagnetism/shc.h"

namespace spindrift {
namespace embedded {
extern const char* const kIgrf14;
}

Expected<MainFieldModel> igrf() { return parse_shc(embedded::kIgrf14); }

TaiTime igrf_end() { return instant_of_year(igrf().value().last_year()); }

}  // namespace spindrift
