/// @file
/// Filters without a gyro that start from several attitudes, since one that starts from a wrong
/// attitude may stay wrong and claim a small sigma. The likelihood of what they measure tells which
/// of them is right.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pipelines/three_axis/unscented/gukf.h"

namespace spindrift {

class GukfBank {
 public:
  /// Starts from nothing but two measured fields, at the time of the second: attitudes turned about
  /// it by steps of 45 deg, with the rate at which the field turns in body axes.
  /// @param dt_s Time between the two, in which the body turns by less than half a turn.
  GukfBank(const GukfModel& model, const SeenField& first, const SeenField& second, double dt_s);
  /// Starts one filter from a known attitude and rate.
  GukfBank(const GukfModel& model, const UncertainMotion& start);

  /// Advances the filters as Gukf::propagate().
  void propagate(double dt_s, const BodyTorques& torques = {},
                 const std::optional<Eigen::Vector3d>& position_icrf_km = std::nullopt);

  /// @name Innovations
  /// Compares a measurement with the most likely filter.
  /// @{
  UnscentedInnovation innovation(const SeenField& field) const { return best().innovation(field); }
  UnscentedInnovation innovation(const SeenSun& sun) const { return best().innovation(sun); }
  UnscentedInnovation innovation(const SeenStars& stars) const { return best().innovation(stars); }
  /// @}

  void update(const SeenField& field);
  void update(const SeenSun& sun) { update_all(sun); }
  void update(const SeenStars& stars) { update_all(stars); }

  /// Returns the most likely filter.
  const Gukf& best() const { return hypotheses_.front().filter; }
  /// Returns by how much it is more likely than every filter more than 15 deg away from it, nats;
  /// infinity where there is none.
  double lead_nats() const;
  /// Returns whether the most likely filter is contradicted by what was measured in the last
  /// minutes, or explains it by errors far beyond the mission file's. The next field then starts
  /// the bank again from nothing.
  bool is_contradicted() const;
  /// Returns whether the attitude of the most likely filter has once been clear.
  bool is_settled() const { return hypotheses_.front().is_settled; }
  /// Returns the number of filters left.
  std::size_t size() const { return hypotheses_.size(); }

 private:
  /// A filter, and what it expected of the last minutes.
  struct Hypothesis {
    Gukf filter;
    double log_likelihood = 0.0;  ///< Nats.
    double squares = 0.0;         ///< Sum of normalised squares, spurious ones bounded.
    double freedom = 0.0;         ///< Its expectation.
    bool is_settled = false;
  };

  void start_from(const SeenField& first, const SeenField& second, double dt_s);
  template <class Measurement>
  void update_all(const Measurement& measurement);
  void choose();
  void settle();
  bool is_apart(const Gukf& other) const;

  GukfModel model_;
  std::vector<Hypothesis> hypotheses_;  ///< The most likely first.
  std::optional<SeenField> last_field_;
  double since_field_s_ = 0.0;
  double since_start_s_ = 0.0;
};

}  // namespace spindrift
