#include "postrender/frames.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <set>

#include "core/base/error.h"

namespace nullcone::postrender {

namespace fs = std::filesystem;

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

/// One path a file, as far as the names tell.
std::string same_name(const std::string& path) { return fs::absolute(path).lexically_normal().string(); }

void check_inputs(const std::vector<FrameFiles>& files) {
  std::set<std::string> asked;
  std::vector<std::string> missing;
  const auto check = [&](const std::string& path) {
    std::error_code error;
    if (asked.insert(path).second && !fs::exists(path, error)) missing.push_back(path);
  };
  for (const FrameFiles& one : files) {
    check(one.data);
    for (const std::string& look : one.looks) check(look);
  }
  if (missing.empty()) return;
  std::string more;
  for (std::size_t i = 1; i < std::min<std::size_t>(missing.size(), 4); ++i)
    more += (i == 1 ? "" : ", ") + missing[i];
  if (missing.size() > 1)
    more = "; nor are " + std::to_string(missing.size() - 1) + " more: " + more +
           (missing.size() > 4 ? ", …" : "");
  throw InputError(missing.front(), "is not there" + more);
}

void check_outputs(const std::vector<FrameFiles>& files) {
  std::set<std::string> inputs, pictures;
  for (const FrameFiles& one : files) {
    inputs.insert(same_name(one.data));
    for (const std::string& look : one.looks) inputs.insert(same_name(look));
  }
  for (const FrameFiles& one : files) {
    if (one.picture.empty()) continue;
    if (inputs.contains(same_name(one.picture)))
      throw InputError("--output", one.picture + " is an input too; expected another name");
    if (!pictures.insert(same_name(one.picture)).second)
      throw InputError("--output", "several frames would be written to " + one.picture +
                                       "; expected #### in the name, for the frame's number");
  }
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

bool FramePatterns::any() const {
  return has_number(data) || has_number(picture) || std::ranges::any_of(looks, has_number);
}

std::vector<FrameFiles> files_of(const FramePatterns& patterns, const std::vector<int>& frames) {
  std::vector<FrameFiles> out;
  for (const int frame : frames) {
    FrameFiles files{
        frame, numbered(patterns.data, frame, "DATA"), {}, numbered(patterns.picture, frame, "--output")};
    for (const std::string& look : patterns.looks) files.looks.push_back(numbered(look, frame, "--look"));
    out.push_back(std::move(files));
  }
  check_outputs(out);
  check_inputs(out);
  return out;
}

}  // namespace nullcone::postrender
