// One picture of nullcone-postrender: its looks, the channels that they need, and what they make of a
// dataset.
#pragma once

#include <string>
#include <vector>

#include "apps/postrender_options.h"
#include "core/record/dataset_file.h"
#include "postrender/frames.h"
#include "postrender/look_source.h"
#include "postrender/renderer.h"

namespace nullcone {

using LookDocuments = std::vector<postrender::LookDocument>;

/// The looks that are stacked in one picture, or that of the scene. Throws InputError.
LookDocuments read_documents(const Manifest& manifest, const postrender::FrameFiles& files,
                             const std::vector<std::string>& settings);

/// All of them at one frame. Throws InputError, also where the dataset lacks a channel.
std::vector<postrender::Look> looks_at(const LookDocuments& documents, const Manifest& manifest,
                                       const std::string& data, int frame,
                                       std::vector<postrender::LookInFull>* in_full = nullptr);
/// The same; throws InputError where one of the pictures would overwrite a file that they name.
std::vector<postrender::Look> looks_at(LookDocuments documents, const Manifest& manifest,
                                       const std::string& data, int frame,
                                       const postrender::PictureNames& pictures);

/// The channels that they need, and no others.
ChannelSet needed_channels(const std::vector<postrender::Look>& looks, const Manifest& manifest);

/// Reads the textures of looks ahead, say while the dataset is read. What fails here, fails again, and with
/// its message, when the texture is wanted.
void read_textures_ahead(const std::vector<postrender::Look>& looks, postrender::TextureCache& textures);

/// Throws InputError where the file cannot hold what a look puts out.
void check_outputs(const std::string& picture, int bits, const std::vector<postrender::Look>& looks);

/// Makes pictures for a file of that name, one look below the other, each with its legend; keeps its memory.
class PictureMaker {
 public:
  PictureMaker(const std::string& picture, int bits);
  const postrender::Image& make(postrender::Renderer& renderer, const std::vector<postrender::Look>& looks);

 private:
  void render(postrender::Renderer& renderer, const postrender::Look& look, postrender::Image& image) const;

  postrender::ImageParts parts_;
  postrender::Image image_;
};

/// A single picture; the exit status.
int render_picture(const PostrenderOptions& options);

/// One line on standard error.
void report_times(const PostrenderOptions& options, const std::string& picture, int width, int height,
                  const Seconds& seconds);

}  // namespace nullcone
