#include "services/simulation/tumbling_scenario.h"

#include <vector>

#include "services/mission/mission_three_axis.h"
#include "services/mission/values.h"
#include "services/simulation/three_axis_scenario.h"

namespace spindrift {

void check_tumbling_scenario(TomlDocument& document) {
  check_within_pass(document, "tumbling.first_star_fix_s");
  check_sensors_on_board(document);
}

TumblingScenario tumbling_scenario(const TomlValues& values, TaiTime start) {
  const ThreeAxisConfig said = three_axis_config(values);
  return {.view = three_axis_view(values, said,
                                  {.star_s = number(values, "tumbling.first_star_fix_s")}),
          .truth = {.body = body_truth(values, said, start),
                    .wheels_body_nms = vector_or_zero(values, "tumbling.wheels_nms")}};
}

}  // namespace spindrift
