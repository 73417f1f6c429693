#include "pipelines/statistics/distributions.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/complement.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cassert>

namespace spindrift {

using boost::math::complement;

double normal_beyond(double chance) {
  assert(chance > 0.0 && chance < 1.0);
  return quantile(complement(boost::math::normal{}, chance));
}

double chi_square_beyond(double chance, double freedom) {
  assert(chance > 0.0 && chance < 1.0 && freedom > 0.0);
  return quantile(complement(boost::math::chi_squared{freedom}, chance));
}

double chi_square_tail(double squares, double freedom) {
  assert(squares >= 0.0 && freedom > 0.0);
  return cdf(complement(boost::math::chi_squared{freedom}, squares));
}

double variance_ratio_tail(double freedom_above, double freedom_below, double ratio) {
  assert(freedom_above > 0.0 && freedom_below > 0.0 && ratio >= 0.0);
  return cdf(complement(boost::math::fisher_f{freedom_above, freedom_below}, ratio));
}

}  // namespace spindrift
