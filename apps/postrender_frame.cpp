#include "apps/postrender_frame.h"

#include <cstdio>
#include <thread>

#include "postrender/color.h"
#include "postrender/inset.h"
#include "postrender/needed_channels.h"
#include "postrender/picture_file.h"
#include "postrender/stack.h"

namespace nullcone {

namespace pr = postrender;

LookDocuments read_documents(const Manifest& manifest, const pr::FrameFiles& files,
                             const std::vector<std::string>& settings) {
  LookDocuments out;
  for (const std::string& file : files.looks.empty() ? std::vector<std::string>{""} : files.looks)
    out.push_back(pr::read_document(manifest, files.data, file, settings));
  return out;
}

std::vector<pr::Look> looks_at(const LookDocuments& documents, const Manifest& manifest,
                               const std::string& data, int frame, std::vector<pr::LookInFull>* in_full) {
  std::vector<pr::Look> out;
  for (const pr::LookDocument& document : documents) {
    pr::LookInFull* full = in_full == nullptr ? nullptr : &in_full->emplace_back();
    out.push_back(pr::look_at(document, manifest, frame, full));
    pr::check_channels(out.back(), manifest, manifest.channels, data);
  }
  return out;
}

std::vector<pr::Look> looks_at(LookDocuments documents, const Manifest& manifest, const std::string& data,
                               int frame, const pr::PictureNames& pictures) {
  pr::LookFiles files;
  for (pr::LookDocument& document : documents) document.source.files = &files;
  std::vector<pr::Look> out = looks_at(documents, manifest, data, frame);
  for (const std::set<std::string>& names : {files.named, files.numbered})
    for (const std::string& name : names) pictures.check_input(name);
  return out;
}

ChannelSet needed_channels(const std::vector<pr::Look>& looks, const Manifest& manifest) {
  ChannelSet out;
  for (const pr::Look& look : looks) out = out | pr::needed_channels(look, manifest);
  return out;
}

void read_textures_ahead(const std::vector<pr::Look>& looks, pr::TextureCache& textures) {
  const auto read = [&](const pr::AppearanceLook& appearance) {
    const auto* image = appearance.texture ? std::get_if<pr::ImageLook>(&*appearance.texture) : nullptr;
    if (image != nullptr) textures.get(image->file, image->pointer, image->alpha);
    const auto* cube = appearance.texture ? std::get_if<pr::CubeLook>(&*appearance.texture) : nullptr;
    if (cube != nullptr) textures.get_cube(cube->files, cube->pointers);
  };
  try {
    for (const pr::Look& look : looks)
      for (const auto& [name, object] : look.objects) {
        if (object.opacity == pr::Number{0}) continue;
        read(object.appearance);
        for (const pr::TimeSliceLook& slice : object.time_slices) read(slice.appearance);
      }
  } catch (const std::exception&) {
    return;
  }
}

void check_outputs(const std::string& picture, int bits, const std::vector<pr::Look>& looks) {
  for (const pr::Look& look : looks) pr::check_output(picture, bits, look.develop.output);
}

PictureMaker::PictureMaker(const std::string& picture, int bits) : parts_(pr::parts_in(picture, bits)) {}

void PictureMaker::render(pr::Renderer& renderer, const pr::Look& look, pr::Image& image) const {
  // Legends are drawn in linear colours.
  const bool drawn_on = !look.legend.empty() && parts_.encoded;
  renderer.render(look, drawn_on ? pr::ImageParts{.exposed = false} : parts_, image);
  pr::draw_inset(look, renderer.manifest(), image);
  if (!drawn_on) return;
  image.encoded = pr::encode_srgb8(image.display);
  image.display.clear();
}

const pr::Image& PictureMaker::make(pr::Renderer& renderer, const std::vector<pr::Look>& looks) {
  if (looks.size() == 1) {
    render(renderer, looks[0], image_);
    return image_;
  }
  std::vector<pr::Image> pictures(looks.size());
  for (std::size_t i = 0; i < looks.size(); ++i) render(renderer, looks[i], pictures[i]);
  image_ = pr::stack(pictures);
  return image_;
}

void report_times(const PostrenderOptions& options, const std::string& picture, int width, int height,
                  const Seconds& seconds) {
  if (!options.common.quiet)
    std::fprintf(stderr, "%s: %d x %d, read %.3f s, rendered %.3f s, written %.3f s\n", picture.c_str(),
                 width, height, seconds.read, seconds.render, seconds.write);
}

int render_picture(const PostrenderOptions& options) {
  const pr::FrameFiles files =
      pr::files_of({options.data, options.looks, options.picture}, {options.frame}).front();
  Stopwatch watch;
  Seconds seconds;
  // Steps 1 and 2: the manifest, then the looks against it.
  const Manifest manifest = read_manifest(files.data);
  const std::vector<pr::Look> looks = looks_at(read_documents(manifest, files, options.settings), manifest,
                                               files.data, options.frame, pr::PictureNames({files}));
  check_outputs(files.picture, options.bits, looks);
  // Step 3: what they need of the dataset, and their textures at the same time.
  const auto textures = std::make_shared<pr::TextureCache>();
  std::jthread ahead([&] { read_textures_ahead(looks, *textures); });
  pr::Renderer renderer(read_dataset(files.data, needed_channels(looks, manifest), false),
                        *pr::kernels().front(), textures);
  seconds.read = watch.lap();
  // Step 4: the picture.
  PictureMaker maker(files.picture, options.bits);
  const pr::Image& image = maker.make(renderer, looks);
  seconds.render = watch.lap();
  if (!options.common.quiet)
    for (const std::string& note : renderer.notes()) std::fprintf(stderr, "note: %s\n", note.c_str());
  pr::write_picture(files.picture, image, options.bits);
  seconds.write = watch.lap();
  if (options.json)
    std::printf(
        "{\"width\":%d,\"height\":%d,\"white_cd_m2\":%.9g,"
        "\"seconds\":{\"read\":%.6f,\"render\":%.6f,\"write\":%.6f}}\n",
        image.width, image.height, image.white_cd_m2, seconds.read, seconds.render, seconds.write);
  report_times(options, files.picture, image.width, image.height, seconds);
  return 0;
}

}  // namespace nullcone
