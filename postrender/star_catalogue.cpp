#include "postrender/star_catalogue.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "core/base/error.h"

namespace nullcone::postrender {

namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{512} << 20;
constexpr std::size_t kLongestLine = 1000;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(kBlank) + 1 - first);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> out;
  for (std::size_t from = 0, to = 0; to != std::string_view::npos; from = to + 1) {
    to = line.find(',', from);
    out.push_back(trimmed(line.substr(from, to == std::string_view::npos ? to : to - from)));
  }
  return out;
}

/// Not a number where the field is none.
double number_of(std::string_view field) {
  double out = 0;
  if (field.starts_with('+')) field.remove_prefix(1);
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), out);
  return error == std::errc() && end == field.data() + field.size() && std::isfinite(out) ? out
                                                                                          : std::nan("");
}

struct Column {
  const char* name;
  double least, most;
};
constexpr std::array<Column, 4> kColumns = {
    {{"a right ascension in degrees from -360 to 360", -360, 360},
     {"a declination in degrees from -90 to 90", -90, 90},
     {"a magnitude from -50 to 50", kBrightestMagnitude, kFaintestMagnitude},
     {"a temperature in kelvin from 500 to 1e6", kColdestStar_K, kHottestStar_K}}};

Star make_star(const Direction& direction, double magnitude, double temperature_K) {
  return {
      {static_cast<float>(direction[0]), static_cast<float>(direction[1]), static_cast<float>(direction[2])},
      static_cast<float>(illuminance_lx(magnitude)),
      static_cast<float>(temperature_K)};
}

Star star_of(const std::vector<std::string_view>& fields, const std::string& place) {
  if (fields.size() != 4 && fields.size() != 5)
    throw InputError(place,
                     "holds " + std::to_string(fields.size()) + " column" + (fields.size() == 1 ? "" : "s") +
                         "; expected right ascension, declination, magnitude and temperature, separated by "
                         "commas, and before them a name or nothing");
  std::array<double, 4> row;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string_view field = fields[fields.size() - 4 + i];
    row[i] = number_of(field);
    if (!(row[i] >= kColumns[i].least && row[i] <= kColumns[i].most))
      throw InputError(
          place, std::string("expected ") + kColumns[i].name + ", found '" + printable(field, 40) + "'");
  }
  return make_star(direction_of(row[0], row[1]), row[2], row[3]);
}

/// Names of columns: each field begins with a letter, and none is a number for all that.
bool is_header(const std::vector<std::string_view>& fields) {
  return fields.size() >= 4 && std::ranges::all_of(fields, [](std::string_view field) {
           const char first = field.empty() ? ' ' : static_cast<char>(field[0] | 0x20);
           return first >= 'a' && first <= 'z' && field != "nan" && field != "inf";
         });
}

void check_file(const std::string& path, const std::string& place) {
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw InputError(place, "no such file; expected a catalogue of stars");
  if (!std::filesystem::is_regular_file(path, error))
    throw InputError(place, "not a file; expected a catalogue of stars");
  if (std::filesystem::file_size(path, error) > kLargestFile)
    throw InputError(place, "is larger than 512 MiB; expected a catalogue of stars");
}

/// Numbers by chance from a counter (Steele, Lea and Flood, "Fast splittable pseudorandom number generators",
/// 2014: SplitMix64): each star has its own, whatever comes before it.
class Chance {
 public:
  Chance(std::uint64_t seed, std::uint64_t star) : state_(mixed(seed) ^ mixed(star + kStep)) {}
  /// Within (0, 1).
  double next() {
    state_ += kStep;
    return (static_cast<double>(mixed(state_) >> 12) + 0.5) * 0x1p-52;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15;
  static std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
  }
  std::uint64_t state_;
};

/// N(<m) ~ 10^(slope m), cut off at both ends.
double random_magnitude(const RandomStars& rule, double chance) {
  const auto [from, to] = rule.magnitudes;
  if (rule.slope == 0) return from + chance * (to - from);
  const double bright = std::pow(10, rule.slope * (from - to));
  return to + std::log10(bright + chance * (1 - bright)) / rule.slope;
}

Direction random_direction(const RandomStars& rule, Chance& chance) {
  const double a = chance.next(), b = chance.next(), turn = 2 * std::numbers::pi * b;
  if (!rule.around_deg) {
    const double z = 2 * a - 1, r = std::sqrt(1 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
  }
  const double radian = std::numbers::pi / 180;
  const double away = std::min(rule.spread_deg * radian * std::sqrt(-2 * std::log(a)), std::numbers::pi);
  const auto [ra, dec] = *rule.around_deg;
  const Direction middle = direction_of(ra, dec), north = direction_of(ra, dec + 90),
                  east = direction_of(ra + 90, 0);
  Direction out;
  for (std::size_t i = 0; i < 3; ++i)
    out[i] =
        std::cos(away) * middle[i] + std::sin(away) * (std::cos(turn) * north[i] + std::sin(turn) * east[i]);
  return out;
}

}  // namespace

std::vector<Star> read_stars(const std::string& path, const std::string& pointer) {
  const std::string place = path + ": " + pointer;
  check_file(path, place);
  std::ifstream in(path);
  if (!in) throw InputError(place, "cannot be opened");
  std::vector<Star> out;
  std::string line(kLongestLine + 1, '\0');
  bool first = true;
  for (int number = 1; in.good(); ++number) {
    const std::string here = path + ": line " + std::to_string(number);
    in.getline(line.data(), static_cast<std::streamsize>(line.size()));
    const auto length = static_cast<std::size_t>(in.gcount());
    if (in.fail() && length >= kLongestLine)
      throw InputError(here, "is longer than 1000 characters; expected a star");
    std::string_view text(line.data(), length - (length > 0 && !in.eof() ? 1 : 0));
    if (number == 1 && text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a byte order mark
    text = trimmed(text.substr(0, text.find('#')));
    if (text.empty()) continue;
    const std::vector<std::string_view> fields = fields_of(text);
    const bool header = first && is_header(fields);
    first = false;
    if (header) continue;
    if (out.size() == kMostStars) throw InputError(here, "expected at most 4 million stars");
    out.push_back(star_of(fields, here));
  }
  if (out.empty()) throw InputError(place, "holds no stars");
  return out;
}

void add_random_stars(const RandomStars& rule, std::vector<Star>& out) {
  const auto [coldest, hottest] = rule.temperatures_K;
  for (std::size_t i = 0; i < rule.count; ++i) {
    Chance chance(rule.seed, i);
    const Direction direction = random_direction(rule, chance);
    const double magnitude = random_magnitude(rule, chance.next());
    out.push_back(make_star(direction, magnitude, coldest * std::pow(hottest / coldest, chance.next())));
  }
}

}  // namespace nullcone::postrender
