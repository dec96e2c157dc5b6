#include "postrender/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"

namespace nullcone::postrender {

namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{64} << 20;
constexpr std::size_t kMostRows = 65536;

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

/// Names of columns: no field begins as a number does.
bool is_header(const std::string& line) {
  bool begins = true, letters = false;
  for (const char c : line) {
    const bool numeric = (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
    if (begins && numeric) return false;
    begins = is_space(c);
    letters |= (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  }
  return letters;
}

void check_file(const std::string& path, const std::string& place) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError(place, "no such file; expected a CSV file");
  if (!std::filesystem::is_regular_file(path, error))
    throw InputError(place, "not a file; expected a CSV file");
  if (std::filesystem::file_size(path, error) > kLargestFile)
    throw InputError(place, "is larger than 64 MiB; expected a table of numbers");
}

/// Why a row cannot follow those before it; empty if it can.
std::string fault_of(const std::vector<double>& row, const std::vector<std::vector<double>>& before,
                     const TableKind& kind) {
  if (row.size() < 2) return "expected finite numbers: " + kind.first + " and " + kind.others;
  if (!before.empty() && row.size() != before.front().size())
    return "holds " + std::to_string(row.size()) + " numbers; expected " +
           std::to_string(before.front().size()) + ", as in the lines before";
  if (!(row[0] > 0) && !(kind.zero && row[0] == 0)) return "expected " + kind.first + " above 0";
  if (!before.empty() && !(row[0] > before.back()[0]))
    return "expected " + kind.first + " above that of the line before";
  for (std::size_t i = 1; i < row.size(); ++i)
    if (!(row[i] >= 0 && row[i] <= kind.most))
      return std::string("expected values from 0 to ") + (kind.most < 1e10 ? "1e6" : "1e20");
  return before.size() < kMostRows ? "" : "expected at most 65536 lines of numbers";
}

}  // namespace

std::vector<std::vector<double>> read_table(const std::string& path, const std::string& pointer,
                                            const TableKind& kind) {
  const std::string place = path + ": " + pointer;
  check_file(path, place);
  std::ifstream in(path);
  if (!in) throw InputError(place, "cannot be opened");
  std::vector<std::vector<double>> rows;
  std::string line;
  bool first = true;
  for (int number = 1; std::getline(in, line); ++number) {
    if (number == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);  // a byte order mark
    line.erase(std::min(line.size(), line.find('#')));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const bool header = first && is_header(line);
    first = false;
    if (header) continue;
    std::vector<double> row = numbers_of(line);
    if (const std::string fault = fault_of(row, rows, kind); !fault.empty())
      throw InputError(path + ": line " + std::to_string(number), fault);
    rows.push_back(std::move(row));
  }
  if (rows.size() < 2) throw InputError(place, "holds fewer than two lines of numbers");
  return rows;
}

}  // namespace nullcone::postrender
