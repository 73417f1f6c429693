#include "pipelines/geomagnetism/tables/chebyshev_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace spindrift {
namespace {

using Eigen::Index;
using Eigen::MatrixX3d;
using std::numbers::pi;

constexpr int kMostByEqualSteps = 150;
constexpr unsigned kFewestNodes = 8192;

MatrixX3d fitted_to_equal_steps(const SampledField& field_nt, Index count) {
  const Eigen::ArrayXd angles_rad = Eigen::ArrayXd::LinSpaced(field_nt.cols(), -1.0, 1.0).acos();
  Eigen::MatrixXd polynomials{field_nt.cols(), count};
  for (Index k = 0; k < count; ++k) {
    polynomials.col(k) = (static_cast<double>(k) * angles_rad).cos();
  }
  return polynomials.householderQr().solve(field_nt.transpose());
}

/// Samples the field at the nodes x_j = cos(pi (j + 1/2) / nodes); a row each. Rows are in the
/// order of the transform (Makhoul 1980): those of even j rising, then those of odd j falling.
Expected<MatrixX3d> sampled_at_nodes(const FieldAlong& field, Index nodes) {
  MatrixX3d field_nt{nodes, 3};
  for (Index j = 0; j < nodes; ++j) {
    const double x = std::cos(pi * (static_cast<double>(j) + 0.5) / static_cast<double>(nodes));
    const auto here_nt = field(pi * (x + 1.0));
    if (!here_nt) {
      return Unexpected{here_nt.error()};
    }
    field_nt.row(j % 2 == 0 ? j / 2 : nodes - 1 - j / 2) = here_nt->transpose();
  }
  return field_nt;
}

/// Returns the first coefficients by the discrete cosine transform, as an FFT of the same length.
MatrixX3d transformed(const MatrixX3d& field_nt, Index count) {
  const auto nodes = static_cast<double>(field_nt.rows());
  MatrixX3d coefficients{count, 3};
  Eigen::FFT<double> fft;
  for (Index axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXd samples = field_nt.col(axis);
    Eigen::VectorXcd spectrum;
    fft.fwd(spectrum, samples);
    for (Index k = 0; k < count; ++k) {
      const auto turned = std::polar(1.0, -0.5 * pi * static_cast<double>(k) / nodes);
      coefficients(k, axis) = (k == 0 ? 1.0 : 2.0) / nodes * (turned * spectrum[k]).real();
    }
  }
  return coefficients;
}

}  // namespace

Expected<MatrixX3d> chebyshev_coefficients(const FieldAlong& field, int count) {
  if (count <= kMostByEqualSteps) {
    return sampled(field).map(
        [&](const SampledField& field_nt) { return fitted_to_equal_steps(field_nt, count); });
  }
  const unsigned nodes = std::bit_ceil(std::max(static_cast<unsigned>(count), kFewestNodes));
  return sampled_at_nodes(field, static_cast<Index>(nodes)).map([&](const MatrixX3d& field_nt) {
    return transformed(field_nt, count);
  });
}

}  // namespace spindrift
