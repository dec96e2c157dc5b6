// GYOTO's own integrator on the screens of the study: rays a second, and how far its end points are from
// those that it finds itself at 1e-14. Built and run by bench/gyoto.py; needs the headers of libgyoto8-dev.
//   gyoto_rays RADIUS SIDE TOLERANCE
#include <ctime>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <GyotoDefs.h>
#include <GyotoMetric.h>
#include <GyotoPhoton.h>
#include <GyotoRegister.h>
#include <GyotoScreen.h>
#include <GyotoUtils.h>
#include <GyotoValue.h>

namespace {

using Point = std::array<double, 4>;  // t, x, y, z; of a captured ray: zeros

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Camera {
  Gyoto::SmartPointer<Gyoto::Metric::Generic> metric;
  Gyoto::SmartPointer<Gyoto::Screen> screen;
};

Camera camera_at(double radius) {
  Gyoto::Register::init("stdplug");
  Gyoto::verbose(0);
  std::vector<std::string> plugins = {"stdplug"};
  Camera out;
  out.metric = (*Gyoto::Metric::getSubcontractor("KerrBL", plugins))(nullptr, plugins);
  out.metric->set("Spin", Gyoto::Value(0.9));
  out.screen = new Gyoto::Screen();
  out.screen->metric(out.metric);
  out.screen->time(10000, "geometrical_time");
  out.screen->distance(radius, "geometrical");
  out.screen->inclination(80, "degree");
  out.screen->PALN(180, "degree");
  out.screen->argument(-90, "degree");
  return out;
}

struct Traced {
  std::vector<Point> ends;
  double seconds = 0;  ///< of the integration alone
};

/// Follows the screen's rays back by 2.5 radii (2 from afar) of coordinate time; impact parameters up to 15.
Traced trace(const Camera& camera, double radius, int side, double tolerance) {
  Traced out;
  const double seen = camera.screen->time("geometrical_time"),
               last = seen - (radius > 100 ? 2 : 2.5) * radius;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const auto angle = [&](int k) { return std::atan(15 * ((2 * k + 1.0) / side - 1) / radius); };
      Gyoto::Photon photon(camera.metric, nullptr, camera.screen, angle(i), angle(j));
      photon.integrator("runge_kutta_fehlberg78");
      photon.adaptive(true);
      photon.absTol(tolerance);
      photon.relTol(tolerance);
      const double begin = cpu_seconds();
      photon.xFill(last);
      out.seconds += cpu_seconds() - begin;
      Gyoto::state_t end(8);
      Point point{};
      const std::size_t first = photon.getImin();
      photon.getCoord(first, end);
      if (end[0] <= last && end[1] > 3) {
        photon.getCoord(last, end);
        point = {end[0], end[1] * std::sin(end[2]) * std::cos(end[3]),
                 end[1] * std::sin(end[2]) * std::sin(end[3]), end[1] * std::cos(end[2])};
      }
      out.ends.push_back(point);
    }
  return out;
}

double quantile(std::vector<double>& sorted, double q) {
  return sorted.empty() ? std::nan("")
                        : sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fputs("usage: gyoto_rays RADIUS SIDE TOLERANCE\n", stderr), 2;
  const double radius = std::atof(argv[1]), tolerance = std::atof(argv[3]);
  const int side = std::atoi(argv[2]);
  const Camera camera = camera_at(radius);
  const Traced traced = trace(camera, radius, side, tolerance), truth = trace(camera, radius, side, 1e-14);
  std::vector<double> errors;
  for (std::size_t i = 0; i < truth.ends.size(); ++i) {
    const Point &a = traced.ends[i], &b = truth.ends[i];
    const double r = std::hypot(b[1], b[2], b[3]);
    if (r > 0 && a[0] != 0) errors.push_back(std::hypot(a[1] - b[1], a[2] - b[2], a[3] - b[3]) / r);
  }
  std::sort(errors.begin(), errors.end());
  std::printf("%.6g %.3g %.3g %.3g %zu\n", static_cast<double>(traced.ends.size()) / traced.seconds,
              quantile(errors, 0.5), quantile(errors, 0.9), quantile(errors, 1), errors.size());
}
