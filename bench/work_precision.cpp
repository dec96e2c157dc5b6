// Accuracy against time, for every spacetime, integrator and tolerance (docs/accuracy.md).
//   work_precision [--rays N] [--repeats N] [--only PLACE] > work_precision.csv
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>

#include "bench/work_precision_rays.h"

namespace {

using namespace nullcone;
using namespace nullcone::study;

constexpr Place kPlaces[] = {
    {"minkowski", MetricId::minkowski, 0, 0, 10},
    {"goedel", MetricId::goedel, 1, 0, 10},  // 1.6 turns
    {"schwarzschild_r20", MetricId::kerr_schild, 0, 20, 50},
    {"schwarzschild_r1000", MetricId::kerr_schild, 0, 1000, 2000},
    {"kerr_r20", MetricId::kerr_schild, 0.9, 20, 50},
    {"kerr_r1000", MetricId::kerr_schild, 0.9, 1000, 2000},
};
constexpr double kHalfWidth = 15;  // of the screen at a hole, in M

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::nan("");
  const auto at = static_cast<std::size_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> out(values.size());
  for (std::size_t i = 0; i < order.size();) {  // equal values share their mean rank
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t k = i; k < end; ++k) out[order[k]] = 0.5 * static_cast<double>(i + end - 1);
    i = end;
  }
  return out;
}

/// Spearman's: Pearson's of the ranks. NaN where all are alike.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto x = ranks(a), y = ranks(b);
  const double middle = 0.5 * (static_cast<double>(x.size()) - 1);
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - middle) * (x[i] - middle);
    xy += (x[i] - middle) * (y[i] - middle);
    yy += (y[i] - middle) * (y[i] - middle);
  }
  return xy / std::sqrt(xx * yy);
}

struct Options {
  std::size_t side = 64;
  int repeats = 5;
  const char* only = nullptr;
};

/// What one run says about the rays that were not captured.
struct Findings {
  std::vector<double> error, scaled, estimate, drift;
  double steps = 0, captured_steps = 0, captured_drift = 0;
  std::size_t captured = 0, lost = 0, wrong = 0;
};

Findings compare(const Truth& truth, const std::vector<End>& end, double rtol) {
  Findings out;
  for (std::size_t i = 0; i < end.size(); ++i) {
    out.steps += end[i].steps;
    out.lost += end[i].lost;
    if (end[i].captured) {
      ++out.captured;
      out.captured_steps = std::max(out.captured_steps, end[i].steps);
      out.captured_drift = std::max(out.captured_drift, end[i].drift);
    }
    if (!end[i].lost && end[i].captured != static_cast<bool>(truth.captured[i])) ++out.wrong;
    if (end[i].captured || end[i].lost || truth.captured[i]) continue;
    const double error = error_of(end[i].y, truth.end[i], truth.scale[i]);
    out.error.push_back(error);
    out.estimate.push_back(end[i].error);
    out.drift.push_back(end[i].drift);
    if (truth.clear[i]) out.scaled.push_back(error / (truth.amplification[i] * rtol));
  }
  return out;
}

/// Rank correlations with the true error over rays of different lengths, as a picture's pixels are: of the
/// estimate and of the drift.
std::array<double, 2> rank_mixed(const Truth& truth, const Kernel& kernel, const Accuracy& accuracy) {
  std::vector<double> error, estimate, drift;
  for (const Truth::Part& part : truth.parts) {
    std::vector<End> end(part.start.size());
    kernel.march(part.place, accuracy, {part.start.data(), end.data(), end.size()}, 1);
    for (std::size_t i = 0; i < end.size(); ++i) {
      if (end[i].captured || end[i].lost) continue;
      error.push_back(error_of(end[i].y, part.end[i], length_scale_at(part.place, part.end[i])));
      estimate.push_back(end[i].error);
      drift.push_back(end[i].drift);
    }
  }
  return {rank_correlation(error, estimate), rank_correlation(error, drift)};
}

void study_one(const Place& place, const Truth& truth, const Kernel& kernel, const Accuracy& accuracy,
               const Options& options) {
  const std::size_t n = truth.start.size();
  std::vector<End> end(n);
  const double seconds = kernel.march(place, accuracy, {truth.start.data(), end.data(), n}, options.repeats);
  const Findings f = compare(truth, end, accuracy.rtol);
  std::vector<Start> some;
  for (std::size_t i = 0; i < n; i += 16) some.push_back(truth.start[i]);
  const double refused = refused_share(place, accuracy, some);
  const auto mixed = rank_mixed(truth, kernel, accuracy);
  const auto count = static_cast<double>(n);
  std::printf(
      "%s,%s,%s,%.0e,%zu,%.0f,%.2f,%.1f,%.4f,%.3e,%.3e,%.3e,%.3e,%.3e,%.3e,%.3e,%.3f,%.3f,%.3f,%.3f,%zu,%.0f,"
      "%.2e,%zu,%zu\n",
      place.name.data(), kernel.name.data(), name_of(accuracy.integrator), accuracy.rtol, n, count / seconds,
      1e9 * seconds / f.steps, f.steps / count, refused, quantile(f.error, 0.5), quantile(f.error, 0.9),
      quantile(f.error, 1), quantile(f.scaled, 0.5), quantile(f.scaled, 0.95), quantile(f.drift, 0.5),
      quantile(f.drift, 1), rank_correlation(f.error, f.estimate), rank_correlation(f.error, f.drift),
      mixed[0], mixed[1], f.captured, f.captured_steps, f.captured_drift, f.wrong, f.lost);
  std::fflush(stdout);
}

void study_place(const Place& place, const std::vector<Kernel>& kernels, const Options& options) {
  const Truth truth = find_truth(place, kernels.front(), options.side, kHalfWidth);
  std::fprintf(stderr, "%s: %td of %zu rays captured, amplification %.3g (median), %.3g (most)\n",
               place.name.data(), std::count(truth.captured.begin(), truth.captured.end(), 1),
               truth.start.size(), quantile(truth.amplification, 0.5), quantile(truth.amplification, 1));
  for (const Kernel& kernel : kernels)
    for (std::size_t i = 0; i < kIntegratorNames.size(); ++i)
      for (int digits = 4; digits <= 14; ++digits) {
        const bool all = kernel.name == kernels.front().name;
        if (all || digits == 8)
          study_one(place, truth, kernel, {std::pow(10, -digits), 0, static_cast<Integrator>(i)}, options);
      }
}

std::vector<Kernel> usable_kernels() {
  std::vector<Kernel> out;
  if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    out = {kAvx512Pack, kAvx512Lane};
  else
    std::fputs("work_precision: no AVX-512 here; its rows are left out\n", stderr);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    out.insert(out.end(), {kAvx2Pack, kAvx2Lane});
  else
    std::fputs("work_precision: no AVX2 here; its rows are left out\n", stderr);
  return out;
}

Options read_options(int argc, char** argv) {
  Options out;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (!std::strcmp(argv[i], "--rays"))
      out.side = static_cast<std::size_t>(std::sqrt(std::atof(argv[i + 1])));
    else if (!std::strcmp(argv[i], "--repeats"))
      out.repeats = std::atoi(argv[i + 1]);
    else if (!std::strcmp(argv[i], "--only"))
      out.only = argv[i + 1];
    else
      argc = 0;
  }
  if (argc % 2 == 1 && out.side > 0 && out.repeats > 0) return out;
  std::fputs("usage: work_precision [--rays N] [--repeats N] [--only PLACE]\n", stderr);
  std::exit(2);
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = read_options(argc, argv);
  const auto kernels = usable_kernels();
  if (kernels.empty()) return 1;
  std::fprintf(stderr, "long double rays against elliptic integrals: %.1e rad\n", check_azimuths());
  std::puts(
      "place,kernel,integrator,rtol,rays,rays_per_s,ns_per_step,steps,refused,error_median,error_90,error_"
      "max,"
      "scaled_median,scaled_95,drift_median,drift_max,rank_error,rank_drift,rank_error_mixed,rank_drift_"
      "mixed,captured,captured_steps_max,"
      "captured_drift_max,wrong_fate,lost");
  for (const Place& place : kPlaces)
    if (!options.only || place.name == options.only) study_place(place, kernels, options);
}
