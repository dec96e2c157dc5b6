#include <ImfDeepScanLineOutputPart.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfStdIO.h>
#include <unistd.h>

#include <filesystem>
#include <future>
#include <stdexcept>

#include "core/base/error.h"
#include "core/record/dataset_file.h"
#include "core/record/exr_parts.h"
#include "core/record/file_hash.h"
#include "core/record/whole_file.h"

namespace nullcone {

namespace {

/// The manifest as it stands in the file: with room for numbers that are not known yet.
std::string reserved_text(Manifest manifest) {
  manifest.hits_sha256 = manifest.rays_sha256 = std::string(64, '0');
  manifest.effort = {};
  return manifest_to_json(manifest) + std::string(96, ' ');
}

}  // namespace

struct DatasetWriter::Impl {
  /// The three parts of a file that is being written.
  struct Parts {
    Imf::StdOFStream stream;
    Imf::MultiPartOutputFile file;
    Imf::OutputPart preview;
    Imf::DeepScanLineOutputPart hits;
    Imf::OutputPart rays;

    Parts(std::ofstream& to, const std::string& path, const std::vector<Imf::Header>& headers)
        : stream(to, path.c_str()),
          file(stream, headers.data(), static_cast<int>(headers.size())),
          preview(file, exr::preview_part),
          hits(file, exr::hits_part),
          rays(file, exr::rays_part) {}
  };

  Manifest manifest;
  std::string path, text;
  WholeFile whole;
  std::unique_ptr<Parts> parts;
  Hits shape;
  exr::DeepLine line;
  PayloadHash hash;
  int lines = 0;

  Impl(const std::string& to, const Manifest& from)
      : manifest(from),
        path(to),
        text(reserved_text(from)),
        whole(to),
        shape(empty_hits(from)),
        line(shape, from.width) {
    exr::guard_writing(path, [&] {
      parts = std::make_unique<Parts>(whole.stream(), path, exr::make_headers(manifest, text));
      parts->hits.setFrameBuffer(line.buffer());
    });
  }
  ~Impl() {
    try {
      parts.reset();
    } catch (...) {  // the file is given up
    }
  }

  void add(const Band& band, const Preview& preview) {
    const auto width = static_cast<std::size_t>(manifest.width);
    const int count = static_cast<int>((band.hits.offset.size() - 1) / width);
    if (channel_names(band.hits) != channel_names(shape) ||
        preview.size() != 4 * width * static_cast<std::size_t>(count) ||
        count != std::min(kBandLines, manifest.lines - lines))
      throw std::invalid_argument("a band does not fit the dataset");
    const auto hashed = std::async(std::launch::async, [&] { hash.add(band); });  // ends with this function
    write_preview(preview, count);
    write_hits(band.hits, count);
    parts->rays.setFrameBuffer(
        exr::ray_slices(band.rays, exr::window_of(manifest, lines, count, manifest.samples)));
    parts->rays.writePixels(count * manifest.samples);
    lines += count;
  }

  void write_preview(const Preview& preview, int count) {
    const std::vector<half> colors(preview.begin(), preview.end());
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < exr::kPreviewChannels.size(); ++c)
      buffer.insert(
          exr::kPreviewChannels[c],
          Imf::Slice::Make(Imf::HALF, colors.data() + c, exr::window_of(manifest, lines, count),
                           4 * sizeof(half), 4 * sizeof(half) * static_cast<std::size_t>(manifest.width)));
    parts->preview.setFrameBuffer(buffer);
    parts->preview.writePixels(count);
  }

  void write_hits(const Hits& from, int count) {
    auto& hits = const_cast<Hits&>(from);  // OpenEXR's slices are not const; writing leaves them alone
    const auto width = static_cast<std::size_t>(manifest.width);
    for (std::size_t first = 0; first < width * static_cast<std::size_t>(count); first += width) {
      for (std::size_t x = 0; x < width; ++x)
        line.counts()[x] = static_cast<unsigned>(hits.offset[first + x + 1] - hits.offset[first + x]);
      line.aim(hits, first);
      parts->hits.writePixels(1);
    }
  }

  /// Puts in what is known only now: the manifest's last numbers, then the hash of everything.
  void seal(const Effort& effort) {
    manifest.effort = effort;
    manifest.hits_sha256 = hash.hits(), manifest.rays_sha256 = hash.rays();
    parts.reset();
    whole.stream().flush();
    if (!whole.stream()) throw WorkError(path, "cannot write all of it (is the disk full?)");
    std::string sealed = manifest_to_json(manifest);
    if (sealed.size() > text.size()) throw std::logic_error("the manifest has grown");
    sealed.resize(text.size(), ' ');
    replace(text, sealed);
    const auto place = find_file_hash(whole.descriptor());
    if (!place) throw std::logic_error("the file has no place for its hash");
    put(compute_file_hash(whole.descriptor(), *place), *place);
  }
  void replace(const std::string& before, const std::string& now) {
    const auto place = find_text(whole.descriptor(), before, before.size() + (1 << 20));
    if (!place) throw std::logic_error("the manifest is not in its file");
    put(now, *place);
  }
  void put(const std::string& bytes, std::uint64_t place) {
    if (::pwrite(whole.descriptor(), bytes.data(), bytes.size(), static_cast<off_t>(place)) !=
        static_cast<ssize_t>(bytes.size()))
      throw WorkError(path, "cannot write all of it (is the disk full?)");
  }
};

DatasetWriter::DatasetWriter(const std::string& path, const Manifest& manifest)
    : impl_(std::make_unique<Impl>(path, manifest)) {}
DatasetWriter::~DatasetWriter() = default;
int DatasetWriter::lines() const { return impl_->lines; }
const Manifest& DatasetWriter::manifest() const { return impl_->manifest; }

void DatasetWriter::add(const Band& band, const Preview& preview) {
  exr::guard_writing(impl_->path, [&] { impl_->add(band, preview); });
}

void DatasetWriter::finish(const Effort& effort) {
  exr::guard_writing(impl_->path, [&] {
    if (impl_->lines != impl_->manifest.lines) throw std::logic_error("bands are missing");
    impl_->seal(effort);
    impl_->whole.finish();
  });
}

void DatasetWriter::finish_partial(const std::string& path, const Effort& effort) {
  exr::guard_writing(path, [&] {
    Manifest& manifest = impl_->manifest;
    manifest.traced_lines = impl_->lines;
    while (impl_->lines < manifest.lines) {
      const int count = std::min(kBandLines, manifest.lines - impl_->lines);
      const std::size_t pixels = static_cast<std::size_t>(manifest.width) * static_cast<std::size_t>(count);
      const std::size_t rays = pixels * static_cast<std::size_t>(manifest.samples * manifest.samples);
      Band nothing;
      nothing.hits = impl_->shape;
      nothing.hits.offset.assign(pixels + 1, 0);
      nothing.rays = {std::vector<std::uint32_t>(rays, static_cast<std::uint32_t>(Status::not_traced)),
                      std::vector<std::uint32_t>(rays), std::vector<float>(rays), std::vector<float>(rays)};
      impl_->add(nothing, Preview(4 * pixels));
    }
    impl_->seal(effort);
    impl_->whole.finish(path);
  });
}

void check_place(const std::string& path) { const WholeFile created_and_removed(path); }

void write_dataset(const std::string& path, const Dataset& dataset, const Preview& preview) {
  const Manifest& manifest = dataset.manifest;
  DatasetWriter writer(path, manifest);
  const auto width = 4 * static_cast<std::size_t>(manifest.width);
  for_each_band(manifest.lines, [&](int first, int lines) {
    const auto begin = preview.begin() + static_cast<std::ptrdiff_t>(width * static_cast<std::size_t>(first));
    writer.add(dataset.band(first, lines),
               Preview(begin, begin + static_cast<std::ptrdiff_t>(width * static_cast<std::size_t>(lines))));
  });
  writer.finish(manifest.effort);
}

}  // namespace nullcone
