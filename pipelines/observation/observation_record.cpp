#include "pipelines/observation/observation_record.h"

#include <algorithm>

#include "pipelines/statistics/variance_factor.h"

namespace spindrift {

void ObservationRecord::add(std::span<const Observation> together) {
  for (const Observation& observation : together) {
    const bool is_left_out = observation.rejected_by.has_value();
    for (RecentMean* share : {&recent_share_, &share_from_the_start_, &share_for_noise_}) {
      share->add(is_left_out ? 1.0 : 0.0);
    }
    left_out_ += is_left_out ? 1 : 0;
  }
  const bool with_left_out = share_for_noise_.mean() > rules_.noise_from_share;
  for (const Observation& observation : together) {
    if (with_left_out || !observation.rejected_by) {
      mean_square_.add(observation.bounded_nis(), std::max(observation.residual.freedom, 1));
    }
  }
}

double ObservationRecord::excess_noise() const {
  return mean_square_.count() >= rules_.fewest_freedoms
             ? variance_factor(mean_square_.mean(), mean_square_.count())
             : 1.0;
}

void ObservationRecord::restart() {
  const ObservationRecord before = *this;
  *this = ObservationRecord{rules_};
  share_for_noise_ = before.share_for_noise_;
  mean_square_ = before.mean_square_;
  share_for_noise_.fade(rules_.fewest_freedoms);
  mean_square_.fade(rules_.fewest_freedoms);
}

void ObservationRecord::discard_transient(double most) {
  share_for_noise_.fade(rules_.fewest_freedoms);
  mean_square_.fade(rules_.fewest_freedoms);
  mean_square_.limit(most);
}

}  // namespace spindrift
