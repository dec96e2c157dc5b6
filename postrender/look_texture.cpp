#include "postrender/look_texture.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "postrender/cube_map.h"
#include "postrender/look_changing.h"

namespace nullcone::postrender {

using nlohmann::json;

namespace {

using StillLook = std::variant<ColorTexture, CheckerboardTexture>;

constexpr std::size_t kSteps = 64;  ///< between two keyframes, of colours and squares
constexpr Bounds kPlace = {-1e4, 1e4}, kAngle = {-1e9, 1e9};
constexpr long kMostFrames = 100000;

// --- Where it lies ---

std::array<Number, 2> parse_pair(JsonObject& in, std::string_view key, const LookSource& source,
                                 double fallback) {
  if (!in.has(key)) return {Number{fallback}, Number{fallback}};
  std::vector<Number> pair = parse_numbers(in, key, source, 2, kPlace);
  return {std::move(pair[0]), std::move(pair[1])};
}

constexpr std::array kPlacementKeys = {"offset", "scale", "rotate_deg"};

Placement parse_placement(JsonObject& in, const LookSource& source) {
  Placement out;
  out.offset = parse_pair(in, "offset", source, 0);
  out.scale = parse_pair(in, "scale", source, 1);
  if (in.has("rotate_deg")) out.rotation = parse_rotation(in, source);
  return out;
}

// --- Images ---

/// "map_####.png" -> "map_0042.png"; the number may need more digits.
std::string numbered(const std::string& file, long number) {
  const std::size_t last = file.rfind('#'), before = file.find_last_not_of('#', last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1, width = last + 1 - first;
  std::string digits = std::to_string(number);
  if (digits.size() < width) digits.insert(0, width - digits.size(), '0');
  return file.substr(0, first) + digits + file.substr(last + 1);
}

Timeline parse_timeline(JsonObject& in, double frame) {
  Timeline out;
  const std::string clock = in.word("clock", {"t", "tau", "frame"}, "t");
  out.clock = clock == "t" ? Clock::t : clock == "tau" ? Clock::tau : Clock::frame;
  out.frame = frame;
  out.rate = in.has("rate") ? in.positive("rate") : 1;
  out.from = in.number_or("from", 0);
  out.loop = in.boolean("loop", false);
  out.blend = in.boolean("blend", false);
  return out;
}

MovingLook parse_sequence(JsonObject in, const ImageLook& image, const LookSource& source) {
  MovingLook out;
  const auto ends = in.numbers("frames", 2, 0, 1e9);
  for (std::size_t i = 0; i < 2; ++i)
    if (ends[i] != std::floor(ends[i])) in.refuse("frames/" + std::to_string(i), "expected a whole number");
  const long first = static_cast<long>(ends[0]), last = static_cast<long>(ends[1]);
  if (last < first || last - first >= kMostFrames)
    in.refuse("frames", "expected [first, last], and at most 100000 of them");
  out.timeline = parse_timeline(in, source.frame);
  out.timeline.count = static_cast<std::size_t>(last - first + 1);
  in.finish();
  for (long number = first; number <= last; ++number) {
    ImageLook frame = image;
    frame.file = numbered(image.file, number);
    if (source.files != nullptr) source.files->numbered.insert(frame.file);
    out.frames.emplace_back(std::move(frame));
  }
  return out;
}

/// With the placement where it is a plain one; other ones are put around it.
TextureLook parse_image(JsonObject& in, const LookSource& source, const std::optional<UvTransform>& plain,
                        bool materials) {
  ImageLook image;
  if (materials) image.materials.first = 0;
  const bool film = !materials && in.has("sequence");
  image.file = film ? parse_file_name(in, "file", source) : parse_file(in, "file", source);
  image.pointer = pointer_of(in, "file", source);
  image.uv = plain.value_or(UvTransform{});
  const std::string filter = in.word("filter", {"mipmap", "bilinear", "anisotropic"}, "mipmap");
  image.filter = filter == "mipmap"     ? Filter::mipmap
                 : filter == "bilinear" ? Filter::bilinear
                                        : Filter::anisotropic;
  if (materials) return image;
  image.alpha = in.boolean("alpha", false);
  if (!film) return image;
  if (in.text("file").find('#') == std::string::npos)
    in.refuse("file", "expected a name with #### in the place of the number");
  return parse_sequence(in.object("sequence"), image, source);
}

// --- Cube maps ---

CubeLook parse_cube(JsonObject& in, const LookSource& source) {
  CubeLook out;
  if (in.has("file") == in.has("faces")) in.refuse("", "expected either file or faces");
  const auto add = [&](JsonObject& from, const char* key) {
    out.files.push_back(parse_file(from, key, source));
    out.pointers.push_back(pointer_of(from, key, source));
  };
  if (in.has("file")) {
    add(in, "file");
  } else {
    JsonObject faces = in.object("faces");
    for (const char* name : kCubeFaceNames) add(faces, name);
    faces.finish();
  }
  out.filter =
      in.word("filter", {"mipmap", "bilinear"}, "mipmap") == "mipmap" ? Filter::mipmap : Filter::bilinear;
  return out;
}

// --- Checkerboards and colours ---

/// A list of two colours under `key`.
std::array<Rgb, 2> parse_two_colors(JsonObject& in, std::string_view key) {
  const json& list = in.at(key);
  if (!list.is_array() || list.size() != 2)
    in.refuse(key, "expected a list of two colours [[r, g, b], [r, g, b]]");
  std::array<Rgb, 2> out;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string place = std::string(key) + "/" + std::to_string(i);
    if (!list[i].is_array() || list[i].size() != 3) in.refuse(place, "expected a list of 3 numbers");
    std::vector<double> srgb;
    for (const json& number : list[i]) {
      if (!number.is_number() || !(number.get<double>() >= 0 && number.get<double>() <= 1))
        in.refuse(place, "expected 3 numbers from 0 to 1");
      srgb.push_back(number.get<double>());
    }
    out[i] = decoded(srgb);
  }
  return out;
}

CheckerboardTexture parse_checkerboard(JsonObject& in) {
  CheckerboardTexture board;
  const auto counts = in.numbers("counts", 2, 1, 100000);
  for (std::size_t i = 0; i < 2; ++i) {
    if (counts[i] != std::floor(counts[i]))
      in.refuse("counts/" + std::to_string(i), "expected a whole number");
    board.counts[i] = static_cast<float>(counts[i]);
  }
  if (in.has("colors") == in.has("gradient")) in.refuse("", "expected either colors or gradient");
  if (in.has("colors")) {
    const auto colors = parse_two_colors(in, "colors");
    board.even = {colors[0], colors[0]};
    board.odd = {colors[1], colors[1]};
    return board;
  }
  JsonObject gradient = in.object("gradient");
  board.axis = gradient.word("along", {"u", "v"}) == "u" ? 0 : 1;
  board.even = {parse_color(gradient, "from"), parse_color(gradient, "to")};
  const auto dark = static_cast<float>(gradient.number_or("dark", 0.25, 0, 1));
  board.odd = {dark * board.even[0], dark * board.even[1]};
  gradient.finish();
  return board;
}

/// What is no image, without its placement: at one instant.
StillLook parse_still(JsonObject in) {
  const bool board = in.word("type", {"checkerboard", "color"}) == "checkerboard";
  StillLook out = ColorTexture{};
  if (board) {
    out = parse_checkerboard(in);
  } else {
    out = ColorTexture{parse_color(in, "rgb")};
  }
  in.finish();
  return out;
}

/// What is no image, one node of its keyframes after the other.
TextureLook parse_nodes(json entry, const LookSource& source, const std::string& pointer) {
  for (const char* key : kPlacementKeys) entry.erase(key);
  const Nodes nodes = at_nodes(entry, kSteps, {"counts"}, source.place, pointer);
  MovingLook out;
  for (const json& value : nodes.values)
    std::visit([&](auto&& still) { out.frames.emplace_back(still); },
               parse_still(JsonObject(value, source.place, pointer)));
  out.timeline = nodes.timeline;
  if (out.frames.size() > 1) return out;
  return std::visit([](auto&& still) -> TextureLook { return still; }, out.frames[0]);
}

/// The placement goes around what cannot place itself.
TextureLook placed(TextureLook texture, const Placement& placement) {
  if (auto* moving = std::get_if<MovingLook>(&texture)) {
    moving->placement = placement;
    return texture;
  }
  MovingLook out{placement, {}, {}};
  if (const auto* board = std::get_if<CheckerboardTexture>(&texture)) out.frames.emplace_back(*board);
  if (auto* image = std::get_if<ImageLook>(&texture)) out.frames.emplace_back(std::move(*image));
  if (auto* cube = std::get_if<CubeLook>(&texture)) out.frames.emplace_back(std::move(*cube));
  return out;
}

/// The image itself, where there is one; of a const look a const one.
template <class Look>
auto image_of(Look& texture) -> decltype(std::get_if<ImageLook>(&texture)) {
  if (auto* image = std::get_if<ImageLook>(&texture)) return image;
  auto* moving = std::get_if<MovingLook>(&texture);
  return moving == nullptr ? nullptr : std::get_if<ImageLook>(&moving->frames.front());
}

}  // namespace

Rotation parse_rotation(JsonObject& in, const LookSource& source) {
  Rotation out;
  if (in.at("rotate_deg").is_array()) {
    std::vector<Number> about = parse_numbers(in, "rotate_deg", source, 3, kAngle);
    std::ranges::move(about, out.about_deg.begin());
    return out;
  }
  JsonObject rotation = in.object("rotate_deg");
  const std::vector<double> axis = rotation.numbers("axis", 3, -1e100, 1e100);
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  if (!(length >= 1e-100)) rotation.refuse("axis", "expected a direction, not (nearly) 0");
  out.axis = {axis[0] / length, axis[1] / length, axis[2] / length};
  out.about_deg[0] = parse_number(rotation, "angle_deg", source, kAngle);
  rotation.finish();
  return out;
}

bool is_of_materials(const TextureLook& texture) {
  const ImageLook* image = image_of(texture);
  return image != nullptr && image->materials.first >= 0;
}

TextureLook of_materials(TextureLook texture, MaterialGroup group) {
  if (ImageLook* image = image_of(texture)) image->materials = group;
  return texture;
}

TextureLook parse_texture(JsonObject& outer, const LookSource& source) {
  const json& entry = outer.at("texture");
  JsonObject in = outer.object("texture");
  const std::string type = in.word("type", {"image", "checkerboard", "color", "materials", "cube_map"});
  const std::string pointer = pointer_of(outer, "texture", source);
  if (type == "color") {
    for (const char* key : kPlacementKeys)
      if (in.has(key)) in.refuse(key, "unknown key; a color has no place; expected one of rgb, type");
    return parse_nodes(entry, source, pointer);
  }
  if (type == "cube_map") {
    CubeLook cube = parse_cube(in, source);
    Placement turned;
    if (in.has("rotate_deg")) turned.rotation = parse_rotation(in, source);
    in.finish();
    return turned.rotation ? placed(std::move(cube), turned) : cube;
  }
  const Placement placement = parse_placement(in, source);
  const std::optional<UvTransform> plain = placement.plain();
  if (type == "checkerboard") {
    const bool moved = !plain || *plain != UvTransform{};
    TextureLook board = parse_nodes(entry, source, pointer);
    return moved ? placed(std::move(board), placement) : board;
  }
  TextureLook image = parse_image(in, source, plain, type == "materials");
  in.finish();
  return plain ? image : placed(std::move(image), placement);
}

}  // namespace nullcone::postrender
