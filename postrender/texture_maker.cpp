#include "postrender/texture_maker.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"

namespace nullcone::postrender {

namespace {

ImageTexture without_image(const ImageLook& look) { return {nullptr, look.uv, look.filter, look.alpha}; }

std::string mebibytes(std::size_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

}  // namespace

Texture TextureMaker::make(const TextureLook& look) {
  const auto still = [&](const ImageLook& image) {
    ImageTexture out = without_image(image);
    out.image = cache_.get(image.file, image.pointer, image.alpha, image.materials);
    return out;
  };
  if (const auto* color = std::get_if<ColorTexture>(&look)) return *color;
  if (const auto* board = std::get_if<CheckerboardTexture>(&look)) return *board;
  if (const auto* image = std::get_if<ImageLook>(&look)) return still(*image);
  const auto cube_of = [&](const CubeLook& cube) {
    return CubeTexture{cache_.get_cube(cube.files, cube.pointers), cube.filter};
  };
  if (const auto* cube = std::get_if<CubeLook>(&look)) return cube_of(*cube);
  const MovingLook& moving = std::get<MovingLook>(look);
  auto parts = std::make_shared<MovingTexture::Parts>();
  parts->placement = moving.placement;
  parts->timeline = moving.timeline;
  Film film{parts, {}, {}};
  for (const auto& frame : moving.frames) {
    if (const auto* image = std::get_if<ImageLook>(&frame)) {
      const bool alone = moving.frames.size() == 1;
      parts->frames.emplace_back(alone ? still(*image) : without_image(*image));
      if (!alone) film.looks.push_back(*image);
    } else if (const auto* cube = std::get_if<CubeLook>(&frame)) {
      parts->frames.emplace_back(cube_of(*cube));
    } else if (const auto* board = std::get_if<CheckerboardTexture>(&frame)) {
      parts->frames.emplace_back(*board);
    } else {
      parts->frames.emplace_back(std::get<ColorTexture>(frame));
    }
  }
  film.seen.resize(film.looks.size());
  if (!film.looks.empty()) films_.push_back(std::move(film));
  return MovingTexture{parts};
}

void TextureMaker::read_films(const Dataset& dataset, const Shading& shading) {
  if (films_.empty()) return;
  // Step 1: which film each appearance shows.
  std::vector<Film*> film_of(shading.appearances.size());
  for (std::size_t i = 0; i < film_of.size(); ++i)
    if (const auto* moving = std::get_if<MovingTexture>(&shading.appearances[i].texture))
      for (Film& film : films_)
        if (film.parts == moving->parts) film_of[i] = &film;
  // Step 2: which frames of it are seen.
  const Hits& hits = dataset.hits;
  Coats coats;
  for (std::size_t hit = 0; hit < hits.count(); ++hit) {
    const ObjectShading& object = shading.objects[hits.id[hit] - 1];
    const Times times = {hits.t.empty() ? 0 : static_cast<double>(hits.t[hit]),
                         hits.tau.empty() ? 0 : static_cast<double>(hits.tau[hit]) + object.tau_origin};
    const std::size_t count = find_coats(object, times, coats);
    for (std::size_t k = 0; k < count; ++k) {
      Film* film = film_of[coats[k].appearance];
      if (film == nullptr) continue;
      const Timeline::Place place = film->parts->timeline.at(times);
      film->seen[place.first] = film->seen[place.second] = 1;
    }
  }
  // Step 3: read those.
  for (Film& film : films_) read_frames(film);
}

void TextureMaker::read_frames(Film& film) {
  const auto count = static_cast<std::size_t>(std::ranges::count(film.seen, char{1}));
  std::size_t left = count;
  for (std::size_t i = 0; i < film.seen.size(); ++i) {
    if (film.seen[i] == 0) continue;
    const ImageLook& look = film.looks[i];
    auto& frame = std::get<ImageTexture>(film.parts->frames[i]);
    frame.image = cache_.get(look.file, look.pointer, look.alpha);
    // Those to come are mostly as large as this one.
    const std::size_t each = frame.image->bytes(), all = bytes_ + left * each;
    if (count > 1 && all > most_bytes_)
      throw InputError(look.file + ": " + look.pointer,
                       "the film needs " + std::to_string(count) + " frames at once, " + mebibytes(each) +
                           " each, " + mebibytes(all) + " together; expected at most " +
                           mebibytes(most_bytes_) + " of all films: smaller pictures or fewer of them");
    bytes_ += each;
    --left;
  }
}

}  // namespace nullcone::postrender
