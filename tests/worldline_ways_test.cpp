// Objects on worldlines: by different ways to the same motion, and what cannot move so.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/trace/circling.h"
#include "core/trace/follow.h"
#include "core/trace/metric.h"
#include "tests/same_picture.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace host;

/// A scene with an object whose placing has this worldline, and what else.
std::string with_ball(const std::string& metric, const std::string& more, const std::string& shape,
                      const std::string& worldline, const std::string& placing = "") {
  return R"({"metric": {"name": )" + metric + R"(}, "camera": {"type": "sphere", "resolution": )" +
         pixels(360, 180) + "}, " + more + R"(, "objects": [{"name": "ball", "shape": )" + shape +
         R"(, "placing": {"type": "local", "worldline": )" + worldline + placing + "}}]}";
}
const std::string kBall = R"({"type": "sphere", "radius": 0.35})",
                  kBox = R"({"type": "box", "edges": [0.6, 0.5, 0.4]})";
// Sanitizers look at fewer of them: they are to find other mistakes.
const std::vector<std::string> kShapes = kSanitized ? std::vector{kBox} : std::vector{kBall, kBox},
                               kMetrics = kSanitized ? std::vector<std::string>{R"("goedel", "a": 3)"}
                                                     : std::vector<std::string>{R"("minkowski")",
                                                                                R"("goedel", "a": 3)"};

/// Otherwise the same scene with the first worldline and the second.
void expect_same_way(const std::string& metric, const std::string& more, const std::string& first,
                     const std::string& second, double limit,
                     const std::vector<std::string>& shapes = kShapes) {
  for (const std::string& shape : shapes)
    expect_same_picture(with_ball(metric, more, shape, first), with_ball(metric, more, shape, second), limit,
                        5);
}

const std::string kNear = R"("observer": {"event": [0.3, 0.5, 0.4, 0.3]})";

TEST(Worldlines, OnePieceIsAGeodesic) {
  const std::string event = R"("event": [-2, 1.4, 0.3, 0.1])", velocity = R"("velocity": [0.2, -0.5, 0.1])";
  for (const std::string& metric : kMetrics)
    expect_same_way(
        metric, kNear, R"({"type": "geodesic", )" + event + ", " + velocity + "}",
        R"({"type": "piecewise", )" + event + R"(, "pieces": [{)" + velocity + R"(, "duration": 3}]})", 1e-8);
}

TEST(Worldlines, AccelerationByNothingIsAGeodesic) {
  const std::string rest = R"("event": [-2, 1.4, 0.3, 0.1], "velocity": [0.2, -0.5, 0.1])";
  for (const std::string& metric : kMetrics)
    expect_same_way(metric, kNear, R"({"type": "geodesic", )" + rest + "}",
                    R"({"type": "accelerated", "acceleration": [0, 0, 0], )" + rest + "}", 1e-8);
}

std::string text_of_event(const Event& x) {
  char text[1024];
  std::snprintf(text, sizeof text, "[%.17g, %.17g, %.17g, %.17g]", x[0], x[1], x[2], x[3]);
  return text;
}

TEST(Worldlines, FreeCirclesAreGeodesics) {
  struct Case {
    std::string metric, name;
    std::vector<double> parameters;
    Motion motion;
    std::string more;
    std::vector<std::string> shapes = kShapes;
  };
  const std::vector<Case> cases = {
      {R"("goedel", "a": 3)",
       "goedel",
       {3},
       {Motion::Type::circular, {-2, 1.4, 0, 0.1}, {}, {}, Motion::Pace::free, 0, false},
       kNear},
      {R"("goedel", "a": 3)",
       "goedel",
       {3},
       {Motion::Type::circular, {-2, 1.4, 0, 0.1}, {}, {}, Motion::Pace::free, 0, true},
       kNear},
      {R"("kerr_schild", "spin": 0.7)",
       "kerr_schild",
       {1, 0.7, 0},
       {Motion::Type::circular, {-30, 8, 0, 0}, {}, {}, Motion::Pace::free, 0, false},
       R"("observer": {"event": [0, 6, 4, 1]}, "accuracy": "reference")",
       {R"({"type": "sphere", "radius": 0.9})", R"({"type": "box", "edges": [1.5, 1.2, 1]})"}}};
  for (const Case& c : cases) {
    if (kSanitized && c.motion.clockwise) continue;
    const Spacetime& spacetime = find_spacetime(c.name);
    const Followed start = follow(spacetime, c.parameters, c.motion, ObserverFrame::at_rest, 0, "test");
    const auto rows = spacetime.metric(c.parameters, start.event);
    const auto rest = spacetime.static_tetrad(c.parameters, start.event);
    const Matrix4<double> g = {Vec4<double>{rows[0]}, Vec4<double>{rows[1]}, Vec4<double>{rows[2]},
                               Vec4<double>{rows[3]}};
    const Tetrad<double> tetrad = {
        {Vec4<double>{rest[0]}, Vec4<double>{rest[1]}, Vec4<double>{rest[2]}, Vec4<double>{rest[3]}}};
    const Vec4<double> u = local_components(g, tetrad, Vec4<double>{start.axes[0]});
    char velocity[1024];
    std::snprintf(velocity, sizeof velocity, "[%.17g, %.17g, %.17g]", u[1] / u[0], u[2] / u[0], u[3] / u[0]);
    const std::string event = R"("event": )" + text_of_event(c.motion.event);
    expect_same_way(c.metric, c.more,
                    R"({"type": "circular", "speed": "free", "clockwise": )" +
                        std::string(c.motion.clockwise ? "true, " : "false, ") + event + "}",
                    R"({"type": "geodesic", "velocity": )" + std::string(velocity) + ", " + event + "}", 2e-7,
                    c.shapes);
  }
}

/// Events of a circle.
std::string table_of(const Circling& circle, double from, double until, int count) {
  std::string out = R"({"type": "tabulated", "events": [)";
  for (int i = 0; i < count; ++i)
    out += (i ? ", " : "") + text_of_event(circle.event(from + (until - from) * i / (count - 1)));
  return out + "]}";
}

TEST(Worldlines, ATableOfACircle) {
  const std::string circle = R"({"type": "circular", "event": [0, 1.4, 0, 0.1], "speed": 0.5})";
  const std::vector<double> none;
  const Motion motion{Motion::Type::circular, {0, 1.4, 0, 0.1}, {}, {}, Motion::Pace::speed, 0.5, false};
  const Circling line = circling({find_spacetime("minkowski"), none}, motion, "test");
  const std::string observer = R"("observer": {"event": [20, 0.5, 0.4, 0.3]})",
                    axes = R"(, "axes": "static")";
  const auto error = [&](int count) {
    return worst_of_picture(with_ball(R"("minkowski")", observer, kBall, circle, axes),
                            with_ball(R"("minkowski")", observer, kBall, table_of(line, 0, 30, count), axes),
                            5);
  };
  const double coarse = error(300), fine = error(600);
  std::printf("a circle of 15 turns by 300 events: %.1e, by 600: %.1e\n", coarse, fine);
  EXPECT_LT(fine, 1e-4);
  // Boosted static axes turn against gyroscopes at a rate that has the second derivative in it.
  EXPECT_LT(fine, coarse / 3.5);
}

TEST(Worldlines, AClosedTimelikeCircleInItsOwnPast) {
  const std::vector<double> a = {1};
  const Motion motion{Motion::Type::circular, {0, 2.6, 0, 0.1}, {}, {}, Motion::Pace::closed, 0, false};
  const Circling line = circling({find_spacetime("goedel"), a}, motion, "test");
  EXPECT_EQ(line.time_rate, 0);
  const double turn = 2 * std::numbers::pi / std::fabs(line.turning);
  const std::string circle = R"({"type": "circular", "event": [0, 2.6, 0, 0.1], "speed": "closed"})",
                    observer = R"("observer": {"event": [0.3, 0, 2.3, 0.3]}, "max_lookback": 6)",
                    ball = R"({"type": "sphere", "radius": 0.1})", axes = R"(, "axes": "static")";
  expect_same_picture(with_ball(R"("goedel")", observer, ball, circle, axes),
                      with_ball(R"("goedel")", observer, ball, table_of(line, 0, turn, 2000), axes), 1e-5, 5);
  const std::string integrated = observer + R"(, "paths": "integrated", "accuracy": "reference")";
  expect_same_picture(with_ball(R"("goedel")", observer, ball, circle),
                      with_ball(R"("goedel")", integrated, ball, circle), 1e-7, 5);
}

TEST(Worldlines, IntegratedPathsSeeTheSame) {
  const std::string
      circle = R"({"type": "circular", "event": [0, 1.4, 0, 0.1], "speed": 0.7})",
      fall = R"({"type": "geodesic", "event": [-2, 1.4, 0.3, 0.1], "velocity": [0.2, -0.4, 0.1]})",
      push = R"({"type": "accelerated", "event": [-2, 1.4, 0.3, 0.1], "acceleration": [0.2, -0.4, 0.1]})",
      rest = R"({"type": "static", "event": [-2, 1.4, 0.3, 0.1]})",
      spin = R"(, "spin": {"axis": [1, 2, 3], "rate_deg": 40})",
      integrated = kNear + R"(, "paths": "integrated", "accuracy": "reference")";
  for (const std::string& metric : kMetrics)
    for (const std::string& line : kSanitized ? std::vector{circle} : std::vector{circle, fall, push, rest})
      expect_same_picture(with_ball(metric, kNear, kBox, line, spin),
                          with_ball(metric, integrated, kBox, line, spin), 1e-6, 5);
}

TEST(Worldlines, WhatCannotMoveSoIsRefused) {
  const auto refused = [](const std::string& metric, const std::string& line,
                          const std::string& shape = kBall) {
    try {
      trace_text(with_ball(metric, kNear, shape, line));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_EQ(refused(R"("minkowski")",
                    R"({"type": "tabulated", "events": [[0, 5, 0, 0], [1, 5.5, 0, 0], [2, 8, 0, 0]]})"),
            "test: /objects/0/placing/worldline/events/1: is not slower than light on its way from here to "
            "the next event");
  EXPECT_EQ(refused(R"("minkowski")", R"({"type": "tabulated", "events": [[2, 5, 0, 0], [1, 5.5, 0, 0]]})"),
            "test: /objects/0/placing/worldline/events/0: goes into the past; expected events in the order "
            "of proper time");
  EXPECT_EQ(refused(R"("goedel")", R"({"type": "circular", "event": [0, 1, 0, 0], "speed": "closed"})"),
            "test: /objects/0/placing/worldline: there is no closed timelike circle through this event");
  EXPECT_EQ(refused(R"("minkowski")",
                    R"({"type": "accelerated", "event": [0, 5, 0, 0], "acceleration": [0, 0, 6]})"),
            "test: /objects/0: 'ball' is too large: parts of it would have to move faster than light");
}

}  // namespace
}  // namespace nullcone::test
