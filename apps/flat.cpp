#include "apps/flat.h"

#include <ImfChannelList.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <bit>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/cryptomatte.h"
#include "apps/info.h"
#include "apps/info_quality.h"
#include "apps/preview.h"
#include "apps/trace_job.h"
#include "core/base/error.h"
#include "core/record/exr_parts.h"
#include "core/record/whole_file.h"

namespace nullcone {

namespace {

constexpr const char* kLayer = "CryptoObject";

/// "CryptoObject00.R", "….G" for rank 0, "….B", "….A" for rank 1, …: a hash and a share each.
std::string layer_channel(int rank, bool share) {
  const std::string number = std::to_string(rank / 2);
  return kLayer + std::string(number.size() < 2 ? "0" : "") + number + "." + "RGBA"[2 * (rank % 2) + share];
}

/// Even, because a layer holds two; no more than there are objects.
int fitting_ranks(int wanted, std::size_t objects) {
  const int ranks = static_cast<int>(std::min(static_cast<std::size_t>(wanted), objects));
  return std::max(2, ranks + ranks % 2);
}

/// Whether the channel of crossings becomes one of the picture by itself; opacity becomes the picture's own
/// A.
bool is_kept(const ChannelInfo& channel) { return channel.name != "A"; }

/// What verification refuses must not spoil a picture either.
float without_nan(float x) { return std::isnan(x) ? 0.0F : x; }
std::uint32_t without_nan(std::uint32_t x) { return x; }

/// Scan lines of the flat picture: a value a pixel in every column.
struct FlatLines {
  Hits hits;
  Rays rays;
  std::vector<half> colors;                        ///< R, G, B, A
  std::vector<std::vector<float>> hashes, shares;  ///< by rank
};

/// The crossing that stands for a pixel: on the ray nearest its centre, the first that is opaque, else the
/// nearest.
std::optional<std::uint64_t> visible(const Hits& hits, std::size_t pixel, std::uint32_t centre) {
  std::optional<std::uint64_t> nearest;
  for (std::uint64_t k = hits.offset[pixel]; k < hits.offset[pixel + 1]; ++k) {
    if (!hits.sample.empty() && hits.sample[k] != centre) continue;
    if (hits.A[k] >= 1) return k;
    if (!nearest) nearest = k;
  }
  return nearest;
}

/// Makes flat scan lines from bands.
class Flattener {
 public:
  Flattener(const Manifest& manifest, const std::string& place, int ranks)
      : width_(static_cast<std::size_t>(manifest.width)),
        samples_(static_cast<std::size_t>(manifest.samples)),
        ranks_(static_cast<std::size_t>(ranks)),
        coverages_(manifest, place) {
    for (const ObjectEntry& object : manifest.objects)
      hashes_.push_back(std::bit_cast<float>(cryptomatte_hash(object.name)));
  }

  FlatLines flatten(const Band& band) {
    FlatLines out;
    const std::size_t pixels = band.hits.offset.size() - 1;
    put_crossings(band.hits, pixels, out);
    put_rays(band.rays, pixels, out.rays);
    put_coverage(band.hits, pixels, out);
    return out;
  }

 private:
  void put_crossings(const Hits& hits, std::size_t pixels, FlatLines& out) const {
    const auto middle = static_cast<std::uint32_t>((samples_ - 1) / 2 * (samples_ + 1));
    Hits seen = empty_like(hits);  // those that stand for a pixel, without gaps
    out.hits = seen;
    for_each_channel([&](const ChannelInfo&, auto& column) { column.resize(pixels); }, out.hits);
    out.hits.Z.assign(pixels, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < pixels; ++i) {
      const auto k = visible(hits, i, middle);
      seen.offset.push_back(seen.count() + (k ? 1 : 0));
      if (k) copy(hits, *k, i, out.hits, seen);
    }
    const Preview preview = make_preview(seen);
    out.colors.resize(preview.size());
    for (std::size_t i = 0; i < preview.size(); ++i) out.colors[i] = preview[i] * out.hits.A[i / 4];
  }

  static void copy(const Hits& from, std::uint64_t k, std::size_t pixel, Hits& to, Hits& seen) {
    for_each_channel(
        [&](const ChannelInfo&, const auto& source, auto& column, auto& list) {
          column[pixel] = without_nan(source[k]);
          list.push_back(column[pixel]);
        },
        from, to, seen);
  }

  /// Of each pixel the worst ray: doubtful ones first, then by error; of equals the one nearest the centre.
  void put_rays(const Rays& rays, std::size_t pixels, Rays& out) const {
    const std::size_t middle = (samples_ - 1) / 2;
    for (std::size_t i = 0; i < pixels; ++i) {
      const std::size_t corner = (i / width_ * samples_ * width_ + i % width_) * samples_;
      const auto quality = [&](std::size_t column, std::size_t row, bool first) {
        const std::size_t at = corner + row * samples_ * width_ + column;
        return RayQuality{first ? 0U : 1U, rays.status[at], rays.steps[at], rays.error[at], rays.drift[at]};
      };
      RayQuality worst = quality(middle, middle, true);
      for (std::size_t row = 0; row < samples_; ++row)
        for (std::size_t column = 0; column < samples_; ++column)
          if (const RayQuality ray = quality(column, row, false); is_worse(ray, worst)) worst = ray;
      out.status.push_back(worst.status), out.steps.push_back(worst.steps);
      out.error.push_back(without_nan(worst.error)), out.drift.push_back(without_nan(worst.drift));
    }
  }

  void put_coverage(const Hits& hits, std::size_t pixels, FlatLines& out) {
    out.hashes.assign(ranks_, std::vector<float>(pixels));
    out.shares = out.hashes;
    for (std::size_t i = 0; i < pixels; ++i) {
      const std::vector<Coverage>& objects = coverages_.of(hits, i);
      for (std::size_t rank = 0; rank < std::min(ranks_, objects.size()); ++rank) {
        out.hashes[rank][i] = hashes_[objects[rank].id - 1];
        out.shares[rank][i] = static_cast<float>(objects[rank].share);
      }
    }
  }

  std::size_t width_, samples_, ranks_;
  Coverages coverages_;
  std::vector<float> hashes_;  ///< by object
};

Imf::Header flat_header(const Manifest& m, int ranks) {
  Imf::Header header(Imath::Box2i({0, 0}, {m.width - 1, m.height - 1}), exr::window_of(m, 0, m.lines));
  header.compression() = Imf::ZIP_COMPRESSION;
  const auto insert = [&](const ChannelInfo& channel) {
    if (is_kept(channel))
      header.channels().insert(std::string(channel.name),
                               Imf::Channel(channel.whole ? Imf::UINT : Imf::FLOAT));
  };
  for (const char* name : exr::kPreviewChannels) header.channels().insert(name, Imf::Channel(Imf::HALF));
  const Hits shape = empty_hits(m);
  for_each_channel([&](const ChannelInfo& channel, const auto&) { insert(channel); }, shape);
  for (const ChannelInfo& channel : kRayChannelInfo) insert(channel);
  for (int rank = 0; rank < ranks; ++rank)
    for (const bool share : {false, true})
      header.channels().insert(layer_channel(rank, share), Imf::Channel(Imf::FLOAT));
  nlohmann::json names = nlohmann::json::array();
  for (const ObjectEntry& object : m.objects) names.push_back(object.name);
  for (const auto& [key, value] : cryptomatte_attributes(kLayer, m.objects))
    header.insert(key, Imf::StringAttribute(value));
  header.insert("nullconeObjects", Imf::StringAttribute(names.dump()));
  header.insert("nullconeHits", Imf::StringAttribute(m.hits_sha256));
  header.insert("nullconeRays", Imf::StringAttribute(m.rays_sha256));
  header.insert("nullconeScene", Imf::StringAttribute(m.scene_sha256));
  header.insert("software", Imf::StringAttribute(m.version));
  return header;
}

Imf::FrameBuffer flat_slices(const FlatLines& lines, const Imath::Box2i& window) {
  Imf::FrameBuffer out = exr::ray_slices(lines.rays, window);
  const auto insert = [&](const std::string& name, const auto& column) {
    using T = exr::Value<decltype(column)>;
    out.insert(name, Imf::Slice::Make(exr::pixel_type<T>(), column.data(), window));
  };
  for_each_channel(
      [&](const ChannelInfo& channel, const auto& column) {
        if (is_kept(channel)) insert(std::string(channel.name), column);
      },
      lines.hits);
  for (std::size_t rank = 0; rank < lines.hashes.size(); ++rank) {
    insert(layer_channel(static_cast<int>(rank), false), lines.hashes[rank]);
    insert(layer_channel(static_cast<int>(rank), true), lines.shares[rank]);
  }
  const std::size_t pixel = 4 * sizeof(half), width = static_cast<std::size_t>(window.size().x + 1);
  for (std::size_t c = 0; c < exr::kPreviewChannels.size(); ++c)
    out.insert(exr::kPreviewChannels[c],
               Imf::Slice::Make(Imf::HALF, lines.colors.data() + c, window, pixel, pixel * width));
  return out;
}

}  // namespace

void write_flat(const std::string& data, const std::string& output, int ranks) {
  DatasetReader reader(data);
  const Manifest& manifest = reader.manifest();
  check_output_name(output);
  std::error_code none;
  if (std::filesystem::equivalent(data, output, none))
    throw InputError(output, "is the dataset itself; expected another name");
  const int fitting = fitting_ranks(ranks, manifest.objects.size());
  Flattener flattener(manifest, data, fitting);
  WholeFile whole(output);
  Imf::StdOFStream stream(whole.stream(), output.c_str());
  std::unique_ptr<Imf::OutputFile> file;
  exr::guard_writing(
      output, [&] { file = std::make_unique<Imf::OutputFile>(stream, flat_header(manifest, fitting)); });
  for_each_run(manifest, [&](int first, int lines) {
    const FlatLines flat = flattener.flatten(reader.band(first, lines));
    exr::guard_writing(output, [&] {
      file->setFrameBuffer(flat_slices(flat, exr::window_of(manifest, first, lines)));
      file->writePixels(lines);
    });
  });
  exr::guard_writing(output, [&] { file.reset(); });
  whole.finish();
}

}  // namespace nullcone
