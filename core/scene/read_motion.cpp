#include "core/scene/read_motion.h"

#include <algorithm>

#include "core/scene/read_placing.h"

namespace nullcone {

namespace {

void read_circle(JsonObject& line, Motion& out) {
  out.event = read_event(line, "event");
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
}

void read_pieces(JsonObject& line, Motion& out) {
  out.event = read_event(line, "event");
  for (JsonObject& piece : line.objects("pieces")) {
    if (out.pieces.size() == 1000) line.refuse("pieces", "expected at most 1000 pieces");
    const Triple velocity = read_velocity(piece, "velocity");
    const double duration = piece.positive("duration");
    if (duration > kLargest) piece.refuse("duration", "expected at most 1e15");
    out.pieces.push_back({velocity, duration});
    piece.finish();
  }
  if (out.pieces.empty()) line.refuse("pieces", "is empty; expected at least one piece");
}

void read_table(JsonObject& line, Motion& out) {
  for (const std::vector<double>& row : line.rows("events", 4, -kLargest, kLargest)) {
    if (out.events.size() == 10'000) line.refuse("events", "expected at most 10000 events");
    const Event event = {row[0], row[1], row[2], row[3]};
    if (!out.events.empty() && event == out.events.back())
      line.refuse("events/" + std::to_string(out.events.size()), "is the event before it once more");
    out.events.push_back(event);
  }
  if (out.events.size() < 2) line.refuse("events", "expected at least two events");
  out.event = out.events.front();
}

}  // namespace

std::vector<std::string> motion_types() {
  return {"geodesic", "accelerated", "circular", "piecewise", "tabulated"};
}

Motion read_motion(JsonObject line) {
  Motion out;
  const std::vector<std::string> types = motion_types();
  const std::string type = line.word("type", types);
  out.type = static_cast<Motion::Type>(std::ranges::find(types, type) - types.begin());
  switch (out.type) {
    case Motion::Type::circular:
      read_circle(line, out);
      break;
    case Motion::Type::piecewise:
      read_pieces(line, out);
      break;
    case Motion::Type::tabulated:
      read_table(line, out);
      break;
    case Motion::Type::accelerated:
      std::ranges::copy(line.numbers("acceleration", 3, -1e100, 1e100), out.acceleration.begin());
      [[fallthrough]];
    case Motion::Type::geodesic:
      out.event = read_event(line, "event");
      out.velocity = read_velocity(line, "velocity");
  }
  line.finish();
  return out;
}

}  // namespace nullcone
