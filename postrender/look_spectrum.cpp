#include "postrender/look_spectrum.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/sha256.h"
#include "postrender/csv.h"
#include "postrender/rgb_basis.h"

namespace nullcone::postrender {

namespace {

constexpr double kLongest_nm = 1e15, kStrongest = 1e20;
constexpr int kDeepest = 8, kMostSpectra = 1000;  ///< spectra within spectra

/// Reads spectra within spectra, and gathers what makes them what they are.
class Reader {
 public:
  explicit Reader(const LookSource& source) : source_(source) {}

  AnySpectrum read(JsonObject in, int depth = 0) {
    if (depth > kDeepest) in.refuse("", "spectra within spectra, deeper than 8");
    if (++count_ > kMostSpectra) in.refuse("", "more than 1000 spectra in one");
    const std::string type = in.word("type", kTypes);
    return finish(in, type, depth);
  }
  AnySpectrum finish(JsonObject& in, const std::string& type, int depth) {
    note(type);
    AnySpectrum out = of_type(in, type, depth);
    if (in.has("luminance_cd_m2")) out = at_luminance(in, out);
    in.finish();
    return out;
  }
  const std::string& key() const { return key_; }
  void note(const std::string& text) { key_ += text + ";"; }

  static inline const std::vector<std::string> kTypes = {
      "black_body", "tabulated",           "lines", "constant", "equal_energy", "power_law",
      "gaussian",   "dominant_wavelength", "sum",   "lit"};

 private:
  double noted(double x) {
    note(nlohmann::json(x).dump());
    return x;
  }
  double radiance(JsonObject& in) { return noted(in.number_or("radiance", 1, 0, kStrongest)); }
  double wavelength(JsonObject& in, std::string_view key) { return noted(in.number(key, 1e-6, kLongest_nm)); }
  double wavelength_or(JsonObject& in, std::string_view key, double fallback) {
    return noted(in.number_or(key, fallback, 0, kLongest_nm));
  }

  AnySpectrum of_type(JsonObject& in, const std::string& type, int depth) {
    if (type == "black_body") return black_body(noted(in.number("temperature_K", 1, 1e9)));
    if (type == "tabulated") return read_tabulated(in);
    if (type == "lines") return read_lines(in);
    if (type == "equal_energy") return constant(radiance(in));
    if (type == "constant") {
      const Band band{wavelength_or(in, "from_nm", 0), wavelength_or(in, "to_nm", kLongest_nm)};
      if (!(band.from < band.to)) in.refuse("to_nm", "expected a number greater than from_nm");
      return constant(radiance(in), band);
    }
    if (type == "power_law") {
      const double at_nm = noted(in.number_or("at_nm", 550, 1e-6, kLongest_nm)),
                   index = noted(in.number("index", -20, 20));
      return power_law(radiance(in), at_nm, index);
    }
    if (type == "gaussian") {
      const double centre_nm = wavelength(in, "centre_nm"), width_nm = noted(in.number("fwhm_nm", 1e-3, 1e9));
      return gaussian(radiance(in), centre_nm, width_nm / 2.3548200450309493);
    }
    if (type == "dominant_wavelength") return read_dominant(in);
    return type == "sum" ? read_sum(in, depth) : read_lit(in, depth);
  }

  AnySpectrum read_tabulated(JsonObject& in) {
    const std::string path = parse_file(in, "file", source_);
    const auto rows = read_table(path, in.where("file").substr(source_.place.size() + 2));
    const bool hold = in.word("beyond", {"zero", "hold"}, "zero") == "hold";
    std::vector<double> nm, value;
    for (const std::vector<double>& row : rows) {
      if (row.size() != 2) in.refuse("file", "expected two columns, wavelength_nm and value, in " + path);
      nm.push_back(row[0]);
      value.push_back(row[1]);
    }
    note(sha256(nlohmann::json({nm, value, hold}).dump()));
    return tabulated(std::move(nm), std::move(value), hold);
  }

  AnySpectrum read_lines(JsonObject& in) {
    const nlohmann::json& list = in.at("lines");
    if (!list.is_array() || list.empty() || list.size() > 1000)
      in.refuse("lines", "expected a list of 1 to 1000 [wavelength_nm, strength]");
    std::vector<SpectralLine> out;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const nlohmann::json& one = list[i];
      const bool pair = one.is_array() && one.size() == 2 && one[0].is_number() && one[1].is_number();
      const double nm = pair ? one[0].get<double>() : 0, strength = pair ? one[1].get<double>() : -1;
      if (!(nm > 1e-6 && nm < kLongest_nm && strength >= 0 && strength <= kStrongest))
        in.refuse("lines/" + std::to_string(i), "expected [wavelength_nm, strength in W m^-2 sr^-1]");
      out.push_back({noted(nm), noted(strength)});
    }
    return line_list(std::move(out));
  }

  /// Equal energy and a line that has the share `purity` of the luminance (CIE's colorimetric purity).
  AnySpectrum read_dominant(JsonObject& in) {
    const double nm = noted(in.number("wavelength_nm", 360, 830)),
                 purity = noted(in.number_or("purity", 1, 0, 1));
    const double level = radiance(in);
    const Sensor& eye = standard_observer();
    const double white = constant(1)->fold(eye, 1)[1], line = eye.at(nm)[1];
    if (!(line > 0)) in.refuse("wavelength_nm", "nothing is seen of this wavelength");
    return sum({constant(level * (1 - purity)), line_list({{nm, level * purity * white / line}})});
  }

  AnySpectrum read_sum(JsonObject& in, int depth) {
    std::vector<AnySpectrum> parts;
    for (JsonObject& part : in.objects("of")) parts.push_back(read(part, depth + 1));
    if (parts.empty()) in.refuse("of", "expected at least one spectrum");
    note("end");
    return sum(std::move(parts));
  }

  AnySpectrum read_lit(JsonObject& in, int depth) {
    AnySpectrum light = read(in.object("light"), depth + 1);
    AnySpectrum reflectance = read(in.object("reflectance"), depth + 1);
    if (!reflectance->lines().empty()) in.refuse("reflectance", "a reflectance cannot have lines");
    return product(std::move(light), std::move(reflectance));
  }

  AnySpectrum at_luminance(JsonObject& in, const AnySpectrum& spectrum) {
    const double wanted = noted(in.number("luminance_cd_m2", 0, kStrongest));
    const double found = fold_with_lines(*spectrum, standard_observer(), 1)[1];
    if (!(found > 1e-200 && found < 1e200))
      in.refuse("luminance_cd_m2", "unshifted, the eye sees nothing of this spectrum, or far too much");
    return scaled(spectrum, wanted / found);
  }

  const LookSource& source_;
  std::string key_;
  int count_ = 0;
};

std::vector<AnySpectrum> read_list(JsonObject& in, Reader& reader, std::size_t least, std::size_t most) {
  std::vector<AnySpectrum> out;
  for (JsonObject& one : in.objects("spectra")) out.push_back(reader.read(one));
  if (out.size() < least || out.size() > most)
    in.refuse("spectra", "expected " +
                             (least == most ? std::to_string(least)
                                            : std::to_string(least) + " to " + std::to_string(most)) +
                             " spectra");
  return out;
}

}  // namespace

SpectrumLook parse_spectrum(JsonObject in, const LookSource& source) {
  using Kind = SpectrumLook::Kind;
  std::vector<std::string> types = {"display", "total_radiance", "rgb", "channels", "materials"};
  types.insert(types.end(), Reader::kTypes.begin(), Reader::kTypes.end());
  const std::string type = in.word("type", types);
  Reader reader(source);
  reader.note(type);
  SpectrumLook out;
  if (type == "display" || type == "total_radiance" || type == "rgb") {
    out.kind = type == "display" ? Kind::display : type == "rgb" ? Kind::mixed : Kind::total_radiance;
    if (type == "rgb") out.spectra.assign(rgb_basis().begin(), rgb_basis().end());
    in.finish();
  } else if (type == "channels" || type == "materials") {
    out.kind = type == "channels" ? Kind::mixed : Kind::materials;
    out.spectra = type == "channels" ? read_list(in, reader, 3, 3) : read_list(in, reader, 1, 255);
    out.physical = true;
    in.finish();
  } else {
    out.kind = Kind::filtered;
    out.physical = true;
    out.spectra = {reader.finish(in, type, 0)};
  }
  out.key = reader.key();
  return out;
}

SpectrumLook three_materials(const SpectrumLook& materials, std::size_t first) {
  SpectrumLook out{SpectrumLook::Kind::mixed, materials.physical, {}, materials.key + std::to_string(first)};
  for (std::size_t i = first; i < first + 3; ++i)
    out.spectra.push_back(i < materials.spectra.size() ? materials.spectra[i] : constant(0));
  return out;
}

std::shared_ptr<const Sensor> parse_sensor(JsonObject& look, std::string_view key, const LookSource& source) {
  if (!look.has(key)) {
    look.note(key, "cie1931");
    return find_sensor("cie1931");
  }
  if (look.is_text(key)) return find_sensor(look.word(key, kSensorNames));
  JsonObject in = look.object(key);
  const std::string path = parse_file(in, "file", source);
  const auto rows = read_table(path, in.where("file").substr(source.place.size() + 2));
  in.finish();
  std::vector<double> nm;
  std::vector<std::array<double, 3>> response;
  for (const std::vector<double>& row : rows) {
    if (row.size() != 2 && row.size() != 4)
      in.refuse("file", "expected wavelength_nm and one or three responses in " + path);
    nm.push_back(row[0]);
    response.push_back({row[1], row[row.size() == 4 ? 2 : 1], row[row.size() == 4 ? 3 : 1]});
  }
  const bool blind = std::ranges::all_of(response, [](const auto& at) { return at[0] + at[1] + at[2] == 0; });
  if (blind) in.refuse("file", "expected responses that are not all 0 in " + path);
  if (nm.back() - nm.front() > 1e5) in.refuse("file", "expected responses over at most 100000 nm in " + path);
  return std::make_shared<Sensor>(make_sensor(sha256(nlohmann::json({nm, response}).dump()), nm, response));
}

}  // namespace nullcone::postrender
