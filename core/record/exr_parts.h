// The parts of a dataset file as OpenEXR sees them: their headers, and columns as its frame buffers.
#pragma once

#include <ImfDeepFrameBuffer.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>

#include <new>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/record/dataset.h"

namespace nullcone::exr {

inline constexpr const char* kManifest = "nullconeManifest";
/// See file_hash.h.
inline constexpr const char* kFileHash = "nullconeSha256";
inline constexpr std::array kPreviewChannels = {"R", "G", "B", "A"};
enum Part { preview_part, hits_part, rays_part };
inline constexpr std::array kPartNames = {"preview", "hits", "rays"};

template <class Column>
using Value = typename std::remove_cvref_t<Column>::value_type;
template <class T>
constexpr Imf::PixelType pixel_type() {
  return std::is_same_v<T, float> ? Imf::FLOAT : Imf::UINT;
}

/// The lines `first` to `first + lines` of the manifest's window, in pixels, or in rays for `samples` > 1.
Imath::Box2i window_of(const Manifest& manifest, int first, int lines, int samples = 1);

/// Headers of the three parts; `text` is the manifest as it stands in the file.
std::vector<Imf::Header> make_headers(const Manifest& manifest, const std::string& text);

/// For every channel a pointer a pixel into its column: deep EXR works on these. One scan line of them serves
/// all (from line to line the stride is 0); those of a whole picture would be twice as large as its records.
class DeepLine {
 public:
  /// For the channels that `shape` has.
  DeepLine(const Hits& shape, int width);

  const Imf::DeepFrameBuffer& buffer() const { return buffer_; }
  std::vector<unsigned>& counts() { return counts_; }
  /// Points into the columns at the line that begins with pixel number `first` of `hits`.
  void aim(Hits& hits, std::size_t first);

 private:
  std::vector<unsigned> counts_;
  std::vector<std::vector<char*>> pointers_;
  Imf::DeepFrameBuffer buffer_;
};

/// The columns of rays as slices of a flat part, over the window.
Imf::FrameBuffer ray_slices(const Rays& rays, const Imath::Box2i& window);

/// Whatever OpenEXR complains about while a file is written becomes a WorkError.
template <class Work>
void guard_writing(const std::string& path, Work&& work) {
  try {
    work();
  } catch (const WorkError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw WorkError(path, std::string("cannot write: ") + error.what());
  }
}

}  // namespace nullcone::exr
