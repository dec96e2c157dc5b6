#include "core/record/dataset_file.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <stdexcept>

#include "core/base/error.h"
#include "core/record/whole_file.h"

namespace nullcone {

namespace {

constexpr const char* kManifest = "nullconeManifest";
constexpr std::array kPreviewChannels = {"R", "G", "B", "A"};

template <class T>
constexpr Imf::PixelType pixel_type() {
  return std::is_same_v<T, float> ? Imf::FLOAT : Imf::UINT;
}
template <class Column>
using Value = typename std::remove_cvref_t<Column>::value_type;

Imf::Header part_header(const Manifest& manifest, const char* name, const char* type,
                        Imf::Compression compression) {
  Imf::Header header(manifest.width, manifest.height);
  header.setName(name);
  header.setType(type);
  header.compression() = compression;
  return header;
}

std::vector<Imf::Header> make_headers(const Dataset& dataset) {
  const Manifest& manifest = dataset.manifest;
  Imf::Header preview = part_header(manifest, "preview", Imf::SCANLINEIMAGE.c_str(), Imf::ZIP_COMPRESSION);
  for (const char* channel : kPreviewChannels) preview.channels().insert(channel, Imf::Channel(Imf::HALF));
  preview.insert(kManifest, Imf::StringAttribute(manifest_to_json(manifest)));
  preview.insert("software", Imf::StringAttribute(manifest.version));

  Imf::Header hits = part_header(manifest, "hits", Imf::DEEPSCANLINE.c_str(), Imf::NO_COMPRESSION);
  hits.insert("deepImageState", Imf::StringAttribute("sorted"));
  for_each_channel(dataset.hits, kHitChannels, [&](const auto& channel, const auto& column) {
    hits.channels().insert(std::string(channel.name), Imf::Channel(pixel_type<Value<decltype(column)>>()));
  });
  Imf::Header rays = part_header(manifest, "rays", Imf::SCANLINEIMAGE.c_str(), Imf::ZIP_COMPRESSION);
  for_each_channel(dataset.rays, kRayChannels, [&](const auto& channel, const auto& column) {
    rays.channels().insert(std::string(channel.name), Imf::Channel(pixel_type<Value<decltype(column)>>()));
  });
  return {preview, hits, rays};
}

/// A slice of a flat part that lies in a plain array, `stride` bytes a pixel.
Imf::Slice flat_slice(Imf::PixelType type, const void* base, std::size_t stride, int width) {
  return {type, const_cast<char*>(static_cast<const char*>(base)), stride,
          stride * static_cast<std::size_t>(width)};
}

/// For every channel a pointer a pixel into its column: deep EXR works on these. One scan line of them serves
/// all (from line to line the stride is 0); those of a whole picture would be twice as large as its records.
struct DeepLine {
  std::vector<std::vector<char*>> pointers;
  Imf::DeepFrameBuffer buffer;

  DeepLine(const Hits& hits, int width, const Imf::Slice& counts) {
    buffer.insertSampleCountSlice(counts);
    pointers.reserve(std::tuple_size_v<decltype(kHitChannels)>);
    for_each_channel(hits, kHitChannels, [&](const auto& channel, const auto& column) {
      using T = Value<decltype(column)>;
      std::vector<char*>& at = pointers.emplace_back(width);
      buffer.insert(
          std::string(channel.name),
          Imf::DeepSlice(pixel_type<T>(), reinterpret_cast<char*>(at.data()), sizeof(char*), 0, sizeof(T)));
    });
  }
  /// Points into the columns at the line that begins with pixel number `first`.
  void aim(Hits& hits, std::size_t first) {
    std::size_t c = 0;
    for_each_channel(hits, kHitChannels, [&](const auto&, auto& column) {
      std::vector<char*>& at = pointers[c++];
      for (std::size_t x = 0; x < at.size(); ++x)
        at[x] = reinterpret_cast<char*>(column.data() + hits.offset[first + x]);
    });
  }
};

void write_preview(Imf::MultiPartOutputFile& file, const Dataset& dataset, const Preview& preview) {
  if (preview.size() != 4 * dataset.pixels()) throw std::invalid_argument("the preview has another size");
  std::vector<half> line(4 * static_cast<std::size_t>(dataset.manifest.width));
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < 4; ++c)
    buffer.insert(kPreviewChannels[c],
                  Imf::Slice(Imf::HALF, reinterpret_cast<char*>(line.data() + c), 4 * sizeof(half), 0));
  Imf::OutputPart part(file, 0);
  part.setFrameBuffer(buffer);
  for (std::size_t first = 0; first < preview.size(); first += line.size()) {
    std::copy_n(preview.begin() + static_cast<std::ptrdiff_t>(first), line.size(), line.begin());
    part.writePixels(1);
  }
}

void write_hits(Imf::MultiPartOutputFile& file, const Dataset& dataset) {
  auto& hits = const_cast<Hits&>(dataset.hits);  // OpenEXR's slices are not const; writing leaves them alone
  std::vector<unsigned> counts(static_cast<std::size_t>(dataset.manifest.width));
  DeepLine line(hits, dataset.manifest.width,
                Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned), 0));
  Imf::DeepScanLineOutputPart part(file, 1);
  part.setFrameBuffer(line.buffer);
  for (std::size_t first = 0; first < dataset.pixels(); first += counts.size()) {
    for (std::size_t x = 0; x < counts.size(); ++x)
      counts[x] = static_cast<unsigned>(hits.offset[first + x + 1] - hits.offset[first + x]);
    line.aim(hits, first);
    part.writePixels(1);
  }
}

void write_rays(Imf::MultiPartOutputFile& file, const Dataset& dataset) {
  Imf::FrameBuffer buffer;
  for_each_channel(dataset.rays, kRayChannels, [&](const auto& channel, const auto& column) {
    using T = Value<decltype(column)>;
    buffer.insert(std::string(channel.name),
                  flat_slice(pixel_type<T>(), column.data(), sizeof(T), dataset.manifest.width));
  });
  Imf::OutputPart part(file, 2);
  part.setFrameBuffer(buffer);
  part.writePixels(dataset.manifest.height);
}

/// A damaged file must not ask for memory far beyond its own size: deflate shrinks 1032 to 1 at most.
void check_length(const std::string& path, std::uint64_t stored_bytes) {
  if (stored_bytes / 1100 > std::filesystem::file_size(path))
    throw InputError(path, "damaged or incomplete: too short for its number of pixels and crossings");
}

void read_hits(Imf::MultiPartInputFile& file, int part_number, const std::string& path, Dataset& dataset) {
  const int width = dataset.manifest.width, height = dataset.manifest.height;
  Hits& hits = dataset.hits;
  std::vector<unsigned> counts(dataset.pixels());
  DeepLine line(hits, width, flat_slice(Imf::UINT, counts.data(), sizeof(unsigned), width));
  Imf::DeepScanLineInputPart part(file, part_number);
  part.setFrameBuffer(line.buffer);  // once: a second call would discard the counts
  part.readPixelSampleCounts(0, height - 1);
  hits.offset.assign(dataset.pixels() + 1, 0);
  std::inclusive_scan(counts.begin(), counts.end(), hits.offset.begin() + 1, std::plus<>(), std::uint64_t{0});
  check_length(path, hits.count() * std::tuple_size_v<decltype(kHitChannels)> * sizeof(float));
  for_each_channel(hits, kHitChannels, [&](const auto&, auto& column) { column.resize(hits.count()); });
  for (int y = 0; y < height; ++y) {
    line.aim(hits, static_cast<std::size_t>(y) * static_cast<std::size_t>(width));
    part.readPixels(y);
  }
}

void read_rays(Imf::MultiPartInputFile& file, int part_number, Dataset& dataset) {
  Imf::FrameBuffer buffer;
  for_each_channel(dataset.rays, kRayChannels, [&](const auto& channel, auto& column) {
    using T = Value<decltype(column)>;
    column.resize(dataset.pixels());
    buffer.insert(std::string(channel.name),
                  flat_slice(pixel_type<T>(), column.data(), sizeof(T), dataset.manifest.width));
  });
  Imf::InputPart part(file, part_number);
  part.setFrameBuffer(buffer);
  part.readPixels(0, dataset.manifest.height - 1);
}

int find_part(const Imf::MultiPartInputFile& file, const std::string& name, const std::string& path) {
  for (int i = 0; i < file.parts(); ++i)
    if (file.header(i).hasName() && file.header(i).name() == name) return i;
  throw InputError(path, "has no part '" + name + "'; expected a nullcone dataset");
}

/// The channels of a part are those of the table, with their types, over the manifest's picture.
template <class Table, class Channels>
void check_part(const Imf::Header& header, const Table& table, const Channels& channels,
                const Manifest& manifest, const std::string& path) {
  const Imath::Box2i& window = header.dataWindow();
  if (window.min.x != 0 || window.min.y != 0 || window.max.x + 1 != manifest.width ||
      window.max.y + 1 != manifest.height)
    throw InputError(path, "the picture's size is not that of the manifest");
  for_each_channel(table, channels, [&](const auto& channel, const auto& column) {
    const Imf::Channel* found = header.channels().findChannel(std::string(channel.name));
    if (!found || found->type != pixel_type<Value<decltype(column)>>() || found->xSampling != 1 ||
        found->ySampling != 1)
      throw InputError(path, "the channel '" + std::string(channel.name) + "' is missing or of another type");
  });
}

Manifest manifest_of(const Imf::MultiPartInputFile& file, const std::string& path) {
  const auto* attribute = file.header(0).findTypedAttribute<Imf::StringAttribute>(kManifest);
  if (!attribute)
    throw InputError(path, "is an OpenEXR file, but not a nullcone dataset (no manifest in its header)");
  return manifest_from_json(attribute->value(), path + ": manifest");
}

/// Runs `read` on the opened file; whatever OpenEXR complains about becomes one line.
template <class Read>
auto with_file(const std::string& path, Read&& read) {
  if (!looks_like_exr(path)) {
    if (!std::ifstream(path))
      throw InputError(path, "cannot open the file; expected a nullcone dataset (.exr)");
    throw InputError(path, "is not an OpenEXR file; expected a nullcone dataset (.exr)");
  }
  try {
    Imf::MultiPartInputFile file(path.c_str());
    return read(file);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(path, std::string("damaged or incomplete: ") + error.what());
  }
}

}  // namespace

void check_place(const std::string& path) { const WholeFile created_and_removed(path); }

void write_dataset(const std::string& path, const Dataset& dataset, const Preview& preview) {
  try {
    WholeFile whole(path);
    {
      // Our own stream: OpenEXR's destructors swallow what goes wrong when the last bytes are written.
      const auto headers = make_headers(dataset);
      Imf::StdOFStream stream(whole.stream(), path.c_str());
      Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()));
      write_preview(file, dataset, preview);
      write_hits(file, dataset);
      write_rays(file, dataset);
    }
    whole.finish();
  } catch (const WorkError&) {
    throw;
  } catch (const std::exception& error) {
    throw WorkError(path, std::string("cannot write: ") + error.what());
  }
}

Dataset read_dataset(const std::string& path) {
  return with_file(path, [&](Imf::MultiPartInputFile& file) {
    Dataset dataset;
    dataset.manifest = manifest_of(file, path);
    const int hits = find_part(file, "hits", path), rays = find_part(file, "rays", path);
    check_part(file.header(hits), dataset.hits, kHitChannels, dataset.manifest, path);
    check_part(file.header(rays), dataset.rays, kRayChannels, dataset.manifest, path);
    check_length(path, dataset.pixels() * sizeof(unsigned));  // the counts alone
    read_hits(file, hits, path, dataset);
    read_rays(file, rays, dataset);
    return dataset;
  });
}

Manifest read_manifest(const std::string& path) {
  return with_file(path, [&](Imf::MultiPartInputFile& file) { return manifest_of(file, path); });
}

bool looks_like_exr(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::array<unsigned char, 4> magic{};
  in.read(reinterpret_cast<char*>(magic.data()), 4);
  return in.gcount() == 4 && magic == std::array<unsigned char, 4>{0x76, 0x2f, 0x31, 0x01};
}

}  // namespace nullcone
