#include "core/scene/read_observer.h"

#include <algorithm>

#include "core/scene/read_placing.h"

namespace nullcone {

namespace {

Motion read_motion(JsonObject line) {
  Motion out;
  const std::string type = line.word("type", {"geodesic", "accelerated", "circular"});
  out.event = read_event(line, "event");
  if (type == "circular") {
    out.type = Motion::Type::circular;
    out.clockwise = line.boolean("clockwise", false);
    if (!line.is_text("speed")) {
      out.speed = line.number("speed", 0, 1);
      if (out.speed == 1) line.refuse("speed", "is not slower than light; expected less than 1");
    } else {
      const bool free = line.word("speed", {"free", "closed"}) == "free";
      out.pace = free ? Motion::Pace::free : Motion::Pace::closed;
    }
    if (out.event[1] == 0 && out.event[2] == 0)
      line.refuse("event", "is on the axis; expected a place to go round it");
  } else {
    out.velocity = read_velocity(line, "velocity");
  }
  if (type == "accelerated") {
    out.type = Motion::Type::accelerated;
    const auto a = line.numbers("acceleration", 3, -1e100, 1e100);
    std::ranges::copy(a, out.acceleration.begin());
  }
  line.finish();
  return out;
}

}  // namespace

Observer read_observer(JsonObject observer) {
  Observer out;
  if (observer.has("worldline")) {
    for (const char* key : {"event", "velocity"})
      if (observer.has(key))
        observer.refuse(key, "stands beside worldline; expected it there, or no worldline");
    out.moves = true;
    out.motion = read_motion(observer.object("worldline"));
    out.proper_time = observer.number_or("proper_time", 0, -kLargest, kLargest);
  } else {
    if (observer.has("proper_time")) observer.refuse("proper_time", "expected worldline beside it");
    if (!observer.has("event")) observer.refuse("event", "missing; expected it, or worldline");
    out.event = read_event(observer, "event");
    out.velocity = read_velocity(observer, "velocity");
  }
  if (observer.word("frame", {"static", "normal"}, "static") == "normal") out.frame = ObserverFrame::normal;
  observer.finish();
  return out;
}

}  // namespace nullcone
