// The rays of the study: their starts, their true ends, and how much each of them amplifies an error.
#pragma once

#include <vector>

#include "bench/work_precision.h"

namespace nullcone::study {

using Numbers = std::array<long double, 8>;

/// What is known of a place's rays before any integrator is measured.
struct Truth {
  std::vector<Start> start;
  std::vector<Numbers> end;           ///< (x^mu, p_mu)
  std::vector<double> amplification;  ///< of relative errors on the way
  std::vector<double> scale;          ///< length scale at the end, against which positions are compared
  std::vector<char> captured, clear;  ///< clear: |b/b_c - 1| > 0.05

  /// Some of the rays, followed for a part of the length only.
  struct Part {
    Place place;
    std::vector<Start> start;
    std::vector<Numbers> end;
  };
  std::array<Part, 4> parts;  ///< of every ray that escapes, one
};

/// Starts on a screen of n x n, half width `half_width` (impact parameters, in M), at an observer at rest at
/// 80 degrees from the axis; without a hole: n^2 directions all over the sphere.
std::vector<Start> screen(const Place& place, std::size_t n, double half_width);
std::vector<std::array<double, 2>> screen_points(std::size_t n, double half_width);
/// One start; X and Y are impact parameters in the screen, to the right and up.
Start screen_ray(const Place& place, double X, double Y);

Truth find_truth(const Place& place, const Kernel& kernel, std::size_t n, double half_width);

/// Follows a ray in long double; false if it is captured before.
bool follow(const Place& place, const Start& start, long double length, Numbers& end);

/// Relative error of an end point: the largest of the errors of position over `scale` and of the momenta over
/// the largest of them.
double error_of(const std::array<double, 8>& y, const Numbers& truth, double scale);

/// By the closed form where there is one, else in long double; false if the ray is captured.
bool true_end(const Place& place, const Start& start, Numbers& end);

double length_scale_at(const Place& place, const Numbers& y);

/// How far the long double rays are from Schwarzschild's elliptic integrals (azimuth, radians).
double check_azimuths();

/// Share of attempts that are refused, over the first rays.
double refused_share(const Place& place, const Accuracy& accuracy, const std::vector<Start>& start);

}  // namespace nullcone::study
