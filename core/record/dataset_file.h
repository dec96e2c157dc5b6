// The dataset as one OpenEXR file: parts `preview`, `hits` (deep) and `rays`; written and read band by band.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/record/dataset.h"

namespace nullcone {

/// The flat picture that any EXR viewer shows first: linear R, G, B, A a pixel, four entries each.
using Preview = std::vector<float>;

/// Throws WorkError where no dataset can be written; removes what killed writers left there.
void check_place(const std::string& path);

/// Writes a dataset beside `path`, band by band, and renames when it is complete and safe on the disk, also
/// from a power cut; else the old file stays and nothing is left behind (see WholeFile). Throws WorkError.
class DatasetWriter {
 public:
  /// The manifest says what will come; times and fingerprints are only known at the end.
  DatasetWriter(const std::string& path, const Manifest& manifest);
  ~DatasetWriter();
  DatasetWriter(const DatasetWriter&) = delete;
  DatasetWriter& operator=(const DatasetWriter&) = delete;

  /// The next kBandLines scan lines of the window, or what is left of it.
  void add(const Band& band, const Preview& preview);
  int lines() const;  ///< so many have come
  /// After the last band; fills in the fingerprints.
  void finish(const Effort& effort);
  /// The same after fewer bands, under another name: the lines that are missing have no crossings and the
  /// status `not_traced`.
  void finish_partial(const std::string& path, const Effort& effort);
  const Manifest& manifest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads a dataset band by band. A foreign, truncated or newer file throws InputError with the reason; the
/// numbers are not verified against their fingerprints (see verify_file()).
class DatasetReader {
 public:
  /// `wanted`: the channels that shall be read (and `id`); those that the file does not have are left out.
  explicit DatasetReader(const std::string& path, ChannelSet wanted = kAllChannels);
  ~DatasetReader();
  DatasetReader(const DatasetReader&) = delete;
  DatasetReader& operator=(const DatasetReader&) = delete;

  const Manifest& manifest() const;
  /// Scan lines `first` to `first + lines` of the window.
  Band band(int first, int lines);
  /// All lines, into a dataset that has this manifest and no records yet.
  void read_all(Dataset& out, bool with_rays = true);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A whole dataset that is in memory.
void write_dataset(const std::string& path, const Dataset& dataset, const Preview& preview);
/// Without `with_rays` the columns of rays stay empty.
Dataset read_dataset(const std::string& path, ChannelSet wanted = kAllChannels, bool with_rays = true);

/// The manifest alone: the header is read, not the pixels.
Manifest read_manifest(const std::string& path);

/// Faults of a file, one line each: its own hash, structure, values, fingerprints. One that cannot be read at
/// all throws InputError.
std::vector<std::string> verify_file(const std::string& path);

/// Whether every byte is as the writer left it, by the file's own hash; nothing for files without one. Does
/// not look at what the bytes mean, and takes a twentieth of the time of verify_file().
std::optional<bool> is_intact(const std::string& path);

/// Whether the file begins as OpenEXR files do (false if it cannot be opened).
bool looks_like_exr(const std::string& path);

std::string manifest_to_json(const Manifest& manifest);
/// `place` stands before complaints.
Manifest manifest_from_json(const std::string& text, const std::string& place);

}  // namespace nullcone
