/// @file
/// What the innovations of one sensor say of it, since the attitude began.

#pragma once

namespace spindrift {

/// Of the normalised innovation squared: so much noise alone reaches once in 1.7 million.
double innovation_gate(int freedom);

class InnovationRecord {
 public:
  /// @param squared_innovation Normalised, of so many degrees of freedom.
  void accepted(double squared_innovation, int freedom);
  void rejected();

  /// Two fifths of the recent samples, and more, are where the attitude does not have them.
  bool many_rejected() const;

  /// None of its samples yet is where the attitude has it.
  bool all_rejected() const { return samples_ > 0.0 && rejected_share_ == 1.0; }

  /// How many times the variance of the samples is what their stated noise makes it, where that is
  /// significantly more than 1; else 1.
  double excess_noise() const;

 private:
  void note(bool was_rejected);

  double samples_ = 0.0;
  double rejected_share_ = 0.0;
  double freedoms_ = 0.0;            ///< So many speak in the following.
  double squared_innovation_ = 1.0;  ///< Mean of one degree of freedom, of accepted samples.
};

}  // namespace spindrift
