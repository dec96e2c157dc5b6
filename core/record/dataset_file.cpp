#include "core/record/dataset_file.h"

#include <ImfArray.h>
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
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "core/base/error.h"

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

/// For every channel a pointer a pixel into its column; counts a pixel. Deep EXR works on these.
struct DeepPointers {
  std::vector<unsigned> counts;
  std::vector<std::vector<char*>> pointers;
  Imf::DeepFrameBuffer buffer;

  DeepPointers(Hits& hits, int width, std::size_t pixels) : counts(pixels) {
    const auto row = static_cast<std::size_t>(width);
    buffer.insertSampleCountSlice(flat_slice(Imf::UINT, counts.data(), sizeof(unsigned), width));
    pointers.reserve(std::tuple_size_v<decltype(kHitChannels)>);
    for_each_channel(hits, kHitChannels, [&](const auto& channel, auto& column) {
      using T = Value<decltype(column)>;
      std::vector<char*>& at = pointers.emplace_back(pixels);
      buffer.insert(std::string(channel.name),
                    Imf::DeepSlice(pixel_type<T>(), reinterpret_cast<char*>(at.data()), sizeof(char*),
                                   sizeof(char*) * row, sizeof(T)));
    });
  }
  void aim(Hits& hits) {
    std::size_t c = 0;
    for_each_channel(hits, kHitChannels, [&](const auto&, auto& column) {
      for (std::size_t i = 0; i < counts.size(); ++i)
        pointers[c][i] = reinterpret_cast<char*>(column.data() + hits.offset[i]);
      ++c;
    });
  }
};

void write_preview(Imf::MultiPartOutputFile& file, const Dataset& dataset, const Preview& preview) {
  std::vector<half> pixels(preview.begin(), preview.end());
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < 4; ++c)
    buffer.insert(kPreviewChannels[c],
                  flat_slice(Imf::HALF, pixels.data() + c, 4 * sizeof(half), dataset.manifest.width));
  Imf::OutputPart part(file, 0);
  part.setFrameBuffer(buffer);
  part.writePixels(dataset.manifest.height);
}

void write_hits(Imf::MultiPartOutputFile& file, const Dataset& dataset) {
  auto& hits = const_cast<Hits&>(dataset.hits);  // OpenEXR's slices are not const; writing leaves them alone
  DeepPointers deep(hits, dataset.manifest.width, dataset.pixels());
  for (std::size_t i = 0; i < dataset.pixels(); ++i)
    deep.counts[i] = static_cast<unsigned>(hits.offset[i + 1] - hits.offset[i]);
  deep.aim(hits);
  Imf::DeepScanLineOutputPart part(file, 1);
  part.setFrameBuffer(deep.buffer);
  part.writePixels(dataset.manifest.height);
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
  Imf::DeepScanLineInputPart part(file, part_number);
  Hits& hits = dataset.hits;
  DeepPointers deep(hits, dataset.manifest.width, dataset.pixels());
  part.setFrameBuffer(deep.buffer);  // once: a second call would discard the counts
  const int last = dataset.manifest.height - 1;
  part.readPixelSampleCounts(0, last);
  hits.offset.assign(dataset.pixels() + 1, 0);
  for (std::size_t i = 0; i < dataset.pixels(); ++i) hits.offset[i + 1] = hits.offset[i] + deep.counts[i];
  check_length(path, hits.count() * std::tuple_size_v<decltype(kHitChannels)> * sizeof(float));
  for_each_channel(hits, kHitChannels, [&](const auto&, auto& column) { column.resize(hits.count()); });
  deep.aim(hits);
  part.readPixels(0, last);
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

void write_dataset(const std::string& path, const Dataset& dataset, const Preview& preview) {
  const std::string beside = path + ".part-" + std::to_string(::getpid());
  try {
    // Our own stream: OpenEXR's destructors swallow what goes wrong when the last bytes are written.
    std::ofstream out(beside, std::ios::binary | std::ios::trunc);
    if (!out) throw WorkError(path, "cannot write there");
    {
      const auto headers = make_headers(dataset);
      Imf::StdOFStream stream(out, beside.c_str());
      Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()));
      write_preview(file, dataset, preview);
      write_hits(file, dataset);
      write_rays(file, dataset);
    }
    out.close();
    if (!out) throw WorkError(path, "cannot write all of it (is the disk full?)");
    if (std::rename(beside.c_str(), path.c_str()) != 0)
      throw WorkError(path, "cannot rename the finished file");
  } catch (const WorkError&) {
    std::remove(beside.c_str());
    throw;
  } catch (const std::exception& error) {
    std::remove(beside.c_str());
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
