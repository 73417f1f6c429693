#include "pipelines/observation/observation_record.h"

#include <algorithm>

#include "pipelines/statistics/significance.h"

namespace spindrift {

void ObservationRecord::add(std::span<const Observation> together) {
  const auto left_out = std::count_if(together.begin(), together.end(),
                                      [](const auto& one) { return one.rejected_by.has_value(); });
  for (RecentMean* share : {&recent_share_, &share_from_the_start_, &share_for_noise_}) {
    share->add(static_cast<double>(left_out), static_cast<double>(together.size()));
  }
  left_out_ += left_out;
  const bool with_left_out = share_for_noise_.mean() > rules_.noise_from_share;
  double squares = 0.0;
  double freedoms = 0.0;
  for (const Observation& observation : together) {
    if (with_left_out || !observation.rejected_by) {
      squares += observation.bounded_nis();
      freedoms += std::max(observation.residual.freedom, 1);
    }
  }
  mean_square_.add(squares, freedoms);
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
