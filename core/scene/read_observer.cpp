#include "core/scene/read_observer.h"

#include "core/scene/read_motion.h"
#include "core/scene/read_placing.h"

namespace nullcone {

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
