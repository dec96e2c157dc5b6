#include "core/record/exr_parts.h"

#include <ImfChannelList.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

namespace nullcone::exr {

namespace {

Imf::Header part_header(const Manifest& manifest, Part part, const std::string& type,
                        Imf::Compression compression, int samples = 1) {
  const Imath::Box2i display({0, 0}, {manifest.width - 1, manifest.height - 1});
  Imf::Header header(display, window_of(manifest, 0, manifest.lines, samples));
  header.setName(kPartNames[part]);
  header.setType(type);
  header.compression() = compression;
  return header;
}

Imf::PixelType pixel_type(const ChannelInfo& channel) { return channel.whole ? Imf::UINT : Imf::FLOAT; }

}  // namespace

Imath::Box2i window_of(const Manifest& manifest, int first, int lines, int samples) {
  const int top = manifest.first_line + first;
  return {{0, samples * top}, {samples * manifest.width - 1, samples * (top + lines) - 1}};
}

std::vector<Imf::Header> make_headers(const Manifest& manifest, const std::string& text) {
  Imf::Header preview = part_header(manifest, preview_part, Imf::SCANLINEIMAGE, Imf::ZIP_COMPRESSION);
  for (const char* channel : kPreviewChannels) preview.channels().insert(channel, Imf::Channel(Imf::HALF));
  preview.insert(kManifest, Imf::StringAttribute(text));
  preview.insert(kFileHash, Imf::StringAttribute(std::string(64, '0')));
  preview.insert("software", Imf::StringAttribute(manifest.version));

  Imf::Header hits = part_header(manifest, hits_part, Imf::DEEPSCANLINE, Imf::NO_COMPRESSION);
  Imf::addDeepImageState(hits, Imf::DIS_SORTED);
  const Hits shape = empty_hits(manifest);
  for_each_channel(
      [&](const ChannelInfo& channel, const auto&) {
        hits.channels().insert(std::string(channel.name), Imf::Channel(pixel_type(channel)));
      },
      shape);

  Imf::Header rays =
      part_header(manifest, rays_part, Imf::SCANLINEIMAGE, Imf::ZIP_COMPRESSION, manifest.samples);
  for (const ChannelInfo& channel : kRayChannelInfo)
    rays.channels().insert(std::string(channel.name), Imf::Channel(pixel_type(channel)));
  return {preview, hits, rays};
}

DeepLine::DeepLine(const Hits& shape, int width) : counts_(static_cast<std::size_t>(width)) {
  buffer_.insertSampleCountSlice(
      Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts_.data()), sizeof(unsigned), 0));
  for_each_channel(
      [&](const ChannelInfo& channel, const auto&) {
        std::vector<char*>& at = pointers_.emplace_back(counts_.size());  // its data stay in place
        buffer_.insert(std::string(channel.name),
                       Imf::DeepSlice(pixel_type(channel), reinterpret_cast<char*>(at.data()), sizeof(char*),
                                      0, sizeof(float)));
      },
      shape);
}

void DeepLine::aim(Hits& hits, std::size_t first) {
  std::size_t c = 0;
  for_each_channel(
      [&](const ChannelInfo&, auto& column) {
        std::vector<char*>& at = pointers_[c++];
        for (std::size_t x = 0; x < at.size(); ++x)
          at[x] = reinterpret_cast<char*>(column.data() + hits.offset[first + x]);
      },
      hits);
}

Imf::FrameBuffer ray_slices(const Rays& rays, const Imath::Box2i& window) {
  Imf::FrameBuffer out;
  for_each_channel(
      [&](const ChannelInfo& channel, const auto& column) {
        out.insert(std::string(channel.name), Imf::Slice::Make(pixel_type(channel), column.data(), window));
      },
      rays);
  return out;
}

}  // namespace nullcone::exr
