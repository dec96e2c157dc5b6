// What nullcone-info tells of a dataset: reports as JSON, and how they are printed for people.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/channels.h"
#include "core/base/status.h"
#include "core/record/dataset_file.h"

namespace nullcone {

using Report = nlohmann::ordered_json;

/// Header, counts, ranges and quality of a dataset, in one pass that holds a few scan lines at a time.
/// `worst`: so many of the worst rays are listed.
Report summary(DatasetReader& reader, std::size_t worst);

/// All records of the pixel x, y of the picture, from a file or from memory. Throws InputError outside the
/// window that is there.
Report pixel_records(DatasetReader& reader, int x, int y);
Report pixel_records(const Dataset& dataset, int x, int y);

/// The file format that this program writes: its version, channels and statuses.
Report format_table();

/// Lines for people.
void print_summary(const std::string& path, const Report& report);
void print_pixel(const Report& report);

/// JSON has no infinities: they become null.
inline Report number(float x) { return std::isfinite(x) ? Report(x) : Report(nullptr); }
inline Report number(std::uint32_t x) { return x; }

inline Report status_name(std::uint32_t status) {
  return status < kStatusNames.size() ? Report(std::string(kStatusNames[status])) : Report(status);
}

/// A pixel that shall be told apart from the good ones.
constexpr bool is_doubtful(std::uint32_t status) {
  return status == static_cast<std::uint32_t>(Status::step_limit) ||
         status == static_cast<std::uint32_t>(Status::not_finite);
}

/// Scan lines of the window, in order, as many at a time as have the rays of one band without samples:
/// f(first, lines), where `first` counts within the window.
template <class F>
void for_each_run(const Manifest& manifest, F&& f) {
  const int most = std::max(1, kBandLines / manifest.samples);
  for (int first = 0; first < manifest.lines; first += most) f(first, std::min(most, manifest.lines - first));
}

}  // namespace nullcone
