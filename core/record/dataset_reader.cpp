#include <ImfChannelList.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStringAttribute.h>
#include <fcntl.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/record/dataset_file.h"
#include "core/record/exr_guard.h"
#include "core/record/exr_parts.h"
#include "core/record/file_hash.h"
#include "core/record/whole_file.h"

namespace nullcone {

namespace {

/// A damaged file must not ask for memory far beyond its own size. Crossings are not compressed; deflate
/// shrinks the rest 1032 to 1 at most.
constexpr std::uint64_t kPlain = 1, kDeflated = 1100;
void check_length(const std::string& path, std::uint64_t file_size, std::uint64_t bytes,
                  std::uint64_t shrinks) {
  if (bytes / shrinks > file_size)
    throw InputError(path, "damaged or incomplete: too short for its number of pixels and crossings");
}

int find_part(const Imf::MultiPartInputFile& file, exr::Part part, const std::string& path) {
  const std::string name = exr::kPartNames[part];
  for (int i = 0; i < file.parts(); ++i)
    if (file.header(i).hasName() && file.header(i).name() == name) return i;
  throw InputError(path, "has no part '" + name + "'; expected a nullcone dataset");
}

void check_channel(const Imf::Header& header, const ChannelInfo& channel, const std::string& path) {
  const Imf::Channel* found = header.channels().findChannel(std::string(channel.name));
  if (!found || found->type != (channel.whole ? Imf::UINT : Imf::FLOAT) || found->xSampling != 1 ||
      found->ySampling != 1)
    throw InputError(path, "the channel '" + std::string(channel.name) + "' is missing or of another type");
}

void check_window(const Imf::Header& header, const Imath::Box2i& expected, const std::string& path) {
  if (header.dataWindow() != expected)
    throw InputError(path, "the window of part '" + header.name() + "' is not that of the manifest");
}

Manifest manifest_of(const Imf::MultiPartInputFile& file, const std::string& path) {
  const auto* attribute = file.header(0).findTypedAttribute<Imf::StringAttribute>(exr::kManifest);
  if (!attribute)
    throw InputError(path, "is an OpenEXR file, but not a nullcone dataset (no manifest in its header)");
  return manifest_from_json(attribute->value(), path + ": manifest");
}

/// Whatever OpenEXR complains about becomes one line.
template <class Read>
auto guarded(const std::string& path, Read&& read) {
  try {
    return read();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(path, std::string("damaged or incomplete: ") + error.what());
  }
}

/// A file whose header has been looked at before OpenEXR takes its word for anything.
std::unique_ptr<Imf::MultiPartInputFile> open_file(const std::string& path) {
  if (!looks_like_exr(path)) {
    if (!std::ifstream(path))
      throw InputError(path, "cannot open the file; expected a nullcone dataset (.exr)");
    throw InputError(path, "is not an OpenEXR file; expected a nullcone dataset (.exr)");
  }
  check_exr_header(path);
  return guarded(path, [&] { return std::make_unique<Imf::MultiPartInputFile>(path.c_str()); });
}

}  // namespace

struct DatasetReader::Impl {
  std::string path;
  std::unique_ptr<Imf::MultiPartInputFile> file;
  Manifest manifest;
  std::uint64_t size, crossing;  ///< bytes of the file, and of a crossing in it
  Hits shape;                    ///< what is read
  std::unique_ptr<Imf::DeepScanLineInputPart> hits;
  std::unique_ptr<Imf::InputPart> rays;
  std::unique_ptr<exr::DeepLine> line;

  Impl(const std::string& from, ChannelSet wanted) : path(from), file(open_file(from)) {
    guarded(path, [&] {
      manifest = manifest_of(*file, path);
      size = std::filesystem::file_size(path);
      shape = empty_hits(manifest, wanted | ChannelSet::of("id"));  // OpenEXR wants something to read
      const int deep = find_part(*file, exr::hits_part, path), flat = find_part(*file, exr::rays_part, path);
      check_window(file->header(deep), exr::window_of(manifest, 0, manifest.lines), path);
      check_window(file->header(flat), exr::window_of(manifest, 0, manifest.lines, manifest.samples), path);
      const Hits all = empty_hits(manifest);
      crossing = sizeof(float) * channel_names(all).size();
      for_each_channel(
          [&](const ChannelInfo& channel, const auto&) { check_channel(file->header(deep), channel, path); },
          all);
      for (const ChannelInfo& channel : kRayChannelInfo) check_channel(file->header(flat), channel, path);
      if (file->header(deep).compression() != Imf::NO_COMPRESSION)
        throw InputError(path, "the part 'hits' is compressed; expected it plain");
      check_length(path, size, manifest.pixels() * sizeof(unsigned), kPlain);  // the counts alone
      check_length(path, size, manifest.rays() * sizeof(float), kDeflated);
      hits = std::make_unique<Imf::DeepScanLineInputPart>(*file, deep);
      rays = std::make_unique<Imf::InputPart>(*file, flat);
      line = std::make_unique<exr::DeepLine>(shape, manifest.width);
      hits->setFrameBuffer(line->buffer());
    });
  }

  /// Puts the lines behind those that are there.
  void read(int first, int lines, Hits& to, Rays* to_rays) {
    for (int y = manifest.first_line + first; y < manifest.first_line + first + lines; ++y) {
      hits->readPixelSampleCounts(y);
      const std::size_t begin = to.offset.size() - 1;
      std::uint64_t count = to.count();
      for (const unsigned n : line->counts()) to.offset.push_back(count += n);
      check_length(path, size, (count - to.offset[begin]) * crossing, kPlain);
      for_each_channel([&](const ChannelInfo&, auto& column) { column.resize(count); }, to);
      line->aim(to, begin);
      hits->readPixels(y);
    }
    if (to_rays) read_rays(first, lines, *to_rays);
  }

  void read_rays(int first, int lines, Rays& to) {
    const int n = manifest.samples;
    const std::size_t more =
        static_cast<std::size_t>(manifest.width) * static_cast<std::size_t>(lines * n * n);
    Rays part;
    for_each_channel([&](const ChannelInfo&, auto& column) { column.resize(more); }, part);
    rays->setFrameBuffer(exr::ray_slices(part, exr::window_of(manifest, first, lines, n)));
    rays->readPixels(n * (manifest.first_line + first), n * (manifest.first_line + first + lines) - 1);
    for_each_channel(
        [](const ChannelInfo&, auto& column, auto& from) {
          if (column.empty()) return column.swap(from);
          column.insert(column.end(), from.begin(), from.end());
        },
        to, part);
  }
};

DatasetReader::DatasetReader(const std::string& path, ChannelSet wanted)
    : impl_(std::make_unique<Impl>(path, wanted)) {}
DatasetReader::~DatasetReader() = default;
const Manifest& DatasetReader::manifest() const { return impl_->manifest; }

Band DatasetReader::band(int first, int lines) {
  Band out;
  out.hits = impl_->shape;
  guarded(impl_->path, [&] { impl_->read(first, lines, out.hits, &out.rays); });
  return out;
}

Dataset read_dataset(const std::string& path, ChannelSet wanted, bool with_rays) {
  DatasetReader reader(path, wanted);
  Dataset out;
  out.manifest = reader.manifest();
  reader.read_all(out, with_rays);
  return out;
}

void DatasetReader::read_all(Dataset& out, bool with_rays) {
  out.hits = impl_->shape;
  // Room for one crossing a pixel; pages that are never touched cost nothing.
  out.hits.offset.reserve(out.pixels() + 1);
  for_each_channel([&](const ChannelInfo&, auto& column) { column.reserve(out.pixels()); }, out.hits);
  guarded(impl_->path,
          [&] { impl_->read(0, out.manifest.lines, out.hits, with_rays ? &out.rays : nullptr); });
}

Manifest read_manifest(const std::string& path) {
  const auto file = open_file(path);
  return guarded(path, [&] { return manifest_of(*file, path); });
}

namespace {

/// Nothing where the file has no hash.
std::optional<bool> matches_its_hash(const std::string& path, unsigned threads) {
  const Descriptor file(path, O_RDONLY);
  const auto place = file ? find_file_hash(file.number()) : std::nullopt;
  if (!place) return std::nullopt;
  return stored_file_hash(file.number(), *place) == compute_file_hash(file.number(), *place, threads);
}

}  // namespace

std::vector<std::string> verify_file(const std::string& path) {
  DatasetReader reader(path);
  const Manifest& manifest = reader.manifest();
  Verifier verifier(manifest);
  for_each_band(manifest.lines, [&](int first, int lines) { verifier.add(reader.band(first, lines)); });
  std::vector<std::string> faults = verifier.faults();
  if (manifest.format > 1 && !matches_its_hash(path, 0).value_or(false))
    faults.emplace_back("file: SHA-256 of the whole file differs from the one in its header");
  return faults;
}

std::optional<bool> is_intact(const std::string& path) {
  return matches_its_hash(path, 1);  // many files are looked at at once
}

bool looks_like_exr(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::array<unsigned char, 4> magic{};
  in.read(reinterpret_cast<char*>(magic.data()), 4);
  return in.gcount() == 4 && magic == std::array<unsigned char, 4>{0x76, 0x2f, 0x31, 0x01};
}

}  // namespace nullcone
