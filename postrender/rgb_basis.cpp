#include "postrender/rgb_basis.h"

#include <Eigen/Dense>

namespace nullcone::postrender {

namespace {

constexpr double kFirst_nm = 360, kStep_nm = 10;
constexpr int kSamples = 48;

double place_nm(int i) { return kFirst_nm + kStep_nm * i; }

/// What the eye sees of each sample's hat function: columns of linear sRGB.
Eigen::MatrixXd responses() {
  Eigen::MatrixXd out(3, kSamples);
  for (int i = 0; i < kSamples; ++i) {
    std::vector<double> nm, value;
    for (int k = std::max(0, i - 1); k <= std::min(kSamples - 1, i + 1); ++k) {
      nm.push_back(place_nm(k));
      value.push_back(k == i ? 1 : 0);
    }
    const Sensor& eye = standard_observer();
    const auto rgb = eye.rgb(tabulated(nm, value, false)->fold(eye, 1));
    for (int c = 0; c < 3; ++c) out(c, i) = rgb[static_cast<std::size_t>(c)];
  }
  return out;
}

/// The smoothest spectrum that is 0 at the `fixed` samples and seen as `rgb`: Lagrange's conditions.
Eigen::VectorXd smoothest(const Eigen::MatrixXd& seen, const Eigen::Vector3d& rgb,
                          const std::vector<bool>& fixed) {
  std::vector<int> free;
  for (int i = 0; i < kSamples; ++i)
    if (!fixed[static_cast<std::size_t>(i)]) free.push_back(i);
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + 3, n + 3);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n + 3);
  for (Eigen::Index k = 0; k < n; ++k) {
    const int i = free[static_cast<std::size_t>(k)];
    A(k, k) = i == 0 || i == kSamples - 1 ? 1 : 2;
    for (Eigen::Index l = 0; l < n; ++l)
      if (std::abs(free[static_cast<std::size_t>(l)] - i) == 1) A(k, l) = -1;
    for (int c = 0; c < 3; ++c) A(k, n + c) = A(n + c, k) = seen(c, i);
  }
  for (int c = 0; c < 3; ++c) b(n + c) = rgb(c);
  const Eigen::VectorXd x = A.fullPivLu().solve(b);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(kSamples);
  for (Eigen::Index k = 0; k < n; ++k) out(free[static_cast<std::size_t>(k)]) = x(k);
  return out;
}

/// Samples that would be negative are held at 0, one after the other.
AnySpectrum basis_spectrum(const Eigen::MatrixXd& seen, int primary) {
  std::vector<bool> fixed(kSamples, false);
  Eigen::VectorXd found;
  const double scale = seen.cwiseAbs().maxCoeff();
  while (true) {
    found = smoothest(seen / scale, Eigen::Vector3d::Unit(primary), fixed);
    Eigen::Index lowest = 0;
    if (!(found.minCoeff(&lowest) < -1e-12)) break;
    fixed[static_cast<std::size_t>(lowest)] = true;
  }
  std::vector<double> nm, value;
  for (int i = 0; i < kSamples; ++i) {
    nm.push_back(place_nm(i));
    value.push_back(std::max(0.0, found(i)) / scale);
  }
  return tabulated(std::move(nm), std::move(value), true);
}

}  // namespace

const std::array<AnySpectrum, 3>& rgb_basis() {
  static const std::array<AnySpectrum, 3> basis = [] {
    const Eigen::MatrixXd seen = responses();
    return std::array{basis_spectrum(seen, 0), basis_spectrum(seen, 1), basis_spectrum(seen, 2)};
  }();
  return basis;
}

}  // namespace nullcone::postrender
