// One channel of a dataset as a picture of numbers.
#pragma once

#include <string>
#include <vector>

#include "core/record/dataset.h"

namespace nullcone::postrender {

/// A channel of `hits` or of `rays`.
struct ChannelChoice {
  std::string name;  ///< all of it
  ChannelInfo info;  ///< of light: its row in kLightChannelInfo
  bool of_rays = false;
  /// What must be read of a dataset: at least one channel of `hits`, and rays come along.
  ChannelSet wanted() const {
    return ChannelSet::of(of_rays ? "id" : std::string_view(name).substr(0, name.find('.')));
  }
};

/// The channel of this name ("shift", "uv.U", "status", "light.sun.0.E"). Throws InputError, naming those
/// that there are; and for one that the dataset in `file` does not have.
ChannelChoice find_channel(const std::string& name, const Manifest& manifest, const std::string& file);

/// One number a pixel: of channels of `hits` that of the nearest crossing, of all samples; not a number where
/// nothing was met, or from where no light comes that its shift, t or tau could tell of. Of channels of
/// `rays` the worst of the pixel's samples, which is the greatest.
std::vector<float> channel_values(const ChannelChoice& choice, const Dataset& dataset);

}  // namespace nullcone::postrender
