#include "core/base/frame_numbers.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>

#include "core/base/error.h"

namespace nullcone {

namespace {

constexpr int kLastFrame = 999'999'999;
constexpr std::size_t kMostFrames = 1'000'000;

[[noreturn]] void refuse_frames(const std::string& message) { throw InputError("--frames", message); }

/// Reads digits from the start of `text` and takes them away.
int take_number(std::string_view& text, std::string_view part) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool digits = !text.empty() && text[0] >= '0' && text[0] <= '9';
  if (!digits || error != std::errc() || number > kLastFrame)
    refuse_frames("'" + printable(part, 40) +
                  "' is no frame; expected whole numbers as 0-249, 0-249:5 or 3,7,9-12");
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

struct Run {
  int first, last, step;
};

/// "7", "0-249" or "0-249:5".
Run parse_run(std::string_view part) {
  std::string_view text = part;
  Run run{take_number(text, part), 0, 1};
  run.last = run.first;
  const auto next = [&](char mark, int& number) {
    if (text.empty() || text[0] != mark) return;
    text.remove_prefix(1);
    number = take_number(text, part);
  };
  next('-', run.last);
  if (part.find('-') != part.npos) next(':', run.step);
  if (!text.empty() || run.last < run.first || run.step < 1)
    refuse_frames("'" + printable(part, 40) +
                  "' is no run of frames; expected first-last or first-last:step");
  return run;
}

}  // namespace

std::vector<int> parse_frames(const std::string& text) {
  std::vector<int> out;
  std::set<int> seen;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const Run run = parse_run(std::string_view(text).substr(at, comma - at));
    for (long frame = run.first; frame <= run.last; frame += run.step) {
      if (!seen.insert(static_cast<int>(frame)).second)
        refuse_frames("frame " + std::to_string(frame) + " stands twice");
      if (out.size() == kMostFrames) refuse_frames("expected at most a million frames");
      out.push_back(static_cast<int>(frame));
    }
    at = comma + 1;
  }
  return out;
}

bool has_number(const std::string& pattern) { return pattern.find('#') != pattern.npos; }

std::string numbered(const std::string& pattern, int frame, const std::string& option) {
  const std::size_t first = pattern.find('#');
  if (first == pattern.npos) return pattern;
  const std::size_t end = std::min(pattern.find_first_not_of('#', first), pattern.size());
  if (pattern.find('#', end) != pattern.npos)
    throw InputError(option,
                     "'" + printable(pattern, 80) + "' has # in two places; expected one run of them");
  std::string digits = std::to_string(frame);
  if (digits.size() < end - first) digits.insert(0, end - first - digits.size(), '0');
  return pattern.substr(0, first) + digits + pattern.substr(end);
}

std::string runs_of(std::vector<std::int64_t> numbers) {
  std::ranges::sort(numbers);
  std::string out;
  for (std::size_t first = 0, last = 0; first < numbers.size(); first = ++last) {
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    out += (out.empty() ? "" : ",") + std::to_string(numbers[first]);
    if (last > first) out += "-" + std::to_string(numbers[last]);
  }
  return out;
}

}  // namespace nullcone
