#include "postrender/csv.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"

namespace nullcone::postrender {

namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{64} << 20;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == ';'; }

/// Empty for a line that is not all numbers.
std::vector<double> numbers_of(const std::string& line) {
  std::vector<double> out;
  const char *at = line.data(), *end = at + line.size();
  while (at != end) {
    if (is_space(*at)) {
      ++at;
      continue;
    }
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value) || (next != end && !is_space(*next))) return {};
    out.push_back(value);
    at = next;
  }
  return out;
}

}  // namespace

std::vector<std::vector<double>> read_table(const std::string& path, const std::string& pointer) {
  const std::string place = path + ": " + pointer;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError(place, "no such file; expected a CSV file");
  if (!std::filesystem::is_regular_file(path, error))
    throw InputError(place, "not a file; expected a CSV file");
  if (std::filesystem::file_size(path, error) > kLargestFile)
    throw InputError(place, "is larger than 64 MiB; expected a table of a spectrum");
  std::ifstream in(path);
  if (!in) throw InputError(place, "cannot be opened");
  std::vector<std::vector<double>> rows;
  std::string line;
  bool header = true;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto refuse = [&](const std::string& message) {
      throw InputError(path + ": line " + std::to_string(number), message);
    };
    const auto start = line.find_first_not_of(" \t\r");
    if (start == std::string::npos || line[start] == '#') continue;
    std::vector<double> row = numbers_of(line);
    if (row.empty() && header) {
      header = false;  // names of columns
      continue;
    }
    header = false;
    if (row.size() < 2) refuse("expected finite numbers: a wavelength in nm and its values");
    if (!rows.empty() && row.size() != rows.front().size())
      refuse("holds " + std::to_string(row.size()) + " numbers; expected " +
             std::to_string(rows.front().size()) + ", as in the lines before");
    if (!(row[0] > 0)) refuse("expected a wavelength above 0 nm");
    if (!rows.empty() && !(row[0] > rows.back()[0]))
      refuse("expected a longer wavelength than in the line before");
    rows.push_back(std::move(row));
  }
  if (rows.size() < 2) throw InputError(place, "holds fewer than two lines of numbers");
  return rows;
}

}  // namespace nullcone::postrender
