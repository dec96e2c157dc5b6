#include "postrender/inset.h"

#include <algorithm>
#include <cmath>

#include "postrender/canvas.h"
#include "postrender/color_bar.h"
#include "postrender/renderer.h"

namespace nullcone::postrender {

namespace {

constexpr const char* kScaleTitle = "observed / emitted frequency";

/// Where things go, in pixels; `scale` is the size of a dot of the font.
struct Plate {
  int left, top, width, height, scale, bar;
  int padding() const { return 4 * scale; }
};

Plate place_of(const LegendLook& legend, int width, int height) {
  Plate out{};
  out.scale = legend.size > 0 ? legend.size : std::clamp((height + 100) / 200, 1, 8);
  int columns = legend.scale ? static_cast<int>(std::string_view(kScaleTitle).size()) : 0;
  for (const std::string& line : legend.lines) columns = std::max(columns, static_cast<int>(line.size()));
  const int lines = static_cast<int>(legend.lines.size()) + (legend.scale ? 1 : 0);
  // Numbers of the scale stand out by half their width: two letters of room on both sides.
  const int inner = columns * text_width("x", out.scale);
  out.bar = std::max(1, inner - text_width("xxxx", out.scale));
  out.width = inner + 2 * out.padding();
  out.height = lines * text_height(out.scale) + (legend.scale ? bar_height(out.scale) : 0) +
               2 * out.padding() - 2 * out.scale;
  const int margin = 4 * out.scale;
  out.left = legend.left ? margin : std::max(margin, width - margin - out.width);
  out.top = legend.top ? margin : std::max(margin, height - margin - out.height);
  return out;
}

/// A line of one object in the middle of its texture, one pixel a frequency ratio.
Dataset line_of(std::uint32_t id, const std::vector<double>& ratios, const Manifest& manifest) {
  Dataset out;
  out.manifest.set_size(static_cast<int>(ratios.size()), 1);
  out.manifest.objects = manifest.objects;
  Hits& hits = out.hits;
  for_each_channel([&](const ChannelInfo&, auto& column) { column.resize(ratios.size()); }, hits);
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    hits.offset.push_back(i + 1);
    hits.A[i] = 1;
    hits.id[i] = id;
    hits.u[i] = hits.v[i] = 0.5f;
    hits.shift[i] = static_cast<float>(ratios[i]);
    hits.mu[i] = 1;
  }
  return out;
}

/// The look of that line: only what colours depend on.
Look look_of_scale(const Look& look, const std::string& object, double white_cd_m2) {
  Look out;
  out.effects = look.effects;
  out.sensor = look.sensor;
  out.develop = look.develop;
  out.develop.white_cd_m2 = white_cd_m2;
  AppearanceLook& appearance = out.objects[object].appearance;
  appearance = look.objects.at(object).appearance;
  if (appearance.texture && !std::holds_alternative<ColorTexture>(*appearance.texture))
    appearance.texture.reset();
  if (appearance.spectrum && appearance.spectrum->kind == SpectrumLook::Kind::materials)
    appearance.spectrum = SpectrumLook{SpectrumLook::Kind::filtered,
                                       true,
                                       {appearance.spectrum->spectra[0]},
                                       appearance.spectrum->key + "first"};
  return out;
}

Image colors_of(const Look& look, const ScaleLook& scale, const std::vector<double>& ratios,
                const Manifest& manifest, double white_cd_m2) {
  std::uint32_t id = 1;
  while (manifest.objects[id - 1].name != scale.object) ++id;
  return Renderer(line_of(id, ratios, manifest)).render(look_of_scale(look, scale.object, white_cd_m2));
}

}  // namespace

void draw_inset(const Look& look, const Manifest& manifest, Image& image) {
  if (look.legend.empty()) return;
  const Plate at = place_of(look.legend, image.width, image.height);
  ColorScale scale;
  Image colors;
  if (look.legend.scale) {
    scale = {ScaleKind::shift, {look.legend.scale->from, look.legend.scale->to}, "shift"};
    colors = colors_of(look, *look.legend.scale, bar_values(scale, at.bar), manifest, image.white_cd_m2);
  }
  const auto draw = [&](std::vector<Rgb>& pixels, const std::vector<Rgb>& bar_colors) {
    if (pixels.empty()) return;
    constexpr Rgb kInk = {1, 1, 1}, kEdge = {0.3f, 0.3f, 0.3f};
    Canvas canvas(image.width, image.height, std::move(pixels));
    canvas.darken(at.left, at.top, at.width, at.height);
    const int left = at.left + at.padding();
    int y = at.top + at.padding();
    const auto write = [&](std::string_view line) {
      canvas.write(left, y, line, kInk, at.scale);
      y += text_height(at.scale);
    };
    for (const std::string& line : look.legend.lines) write(line);
    if (look.legend.scale) {
      write(kScaleTitle);
      const int s = at.scale, bar_left = left + text_width("xx", s);
      canvas.fill(bar_left - s, y - s, at.bar + 2 * s, kBarDots * s + 2 * s, kEdge);
      draw_bar(canvas, {bar_left, y, at.bar, s}, scale, bar_colors, kInk);
    }
    pixels = std::move(canvas.pixels);
  };
  draw(image.exposed, colors.exposed);
  draw(image.display, colors.display);
}

}  // namespace nullcone::postrender
