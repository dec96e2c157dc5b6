#include "apps/postrender_sequence.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "apps/postrender_frame.h"
#include "apps/postrender_movie.h"
#include "apps/postrender_progress.h"
#include "apps/stop_signals.h"
#include "core/base/error.h"
#include "core/base/sha256.h"
#include "core/base/version.h"
#include "core/record/memory.h"
#include "postrender/picture_file.h"
#include "postrender/picture_stamp.h"

namespace nullcone {

namespace {

namespace pr = postrender;

/// One frame, ready to be rendered.
struct Plan {
  Manifest manifest;
  std::vector<pr::Look> looks;
  std::string fingerprint;
  bool there = false;  ///< the picture is whole, of this fingerprint, and newer than what it is made of
};

/// Changes with everything that the picture depends on.
std::string fingerprint_of(const Manifest& manifest, const std::vector<pr::LookInFull>& looks, int bits) {
  Sha256 hash;
  const auto add = [&](const std::string& text) { hash.add(std::string_view(text + "\n")); };
  add(version());
  add(std::to_string(bits));
  for (const int number : {manifest.width, manifest.height, manifest.first_line, manifest.lines,
                           manifest.traced_lines, manifest.samples})
    add(std::to_string(number));
  for (const auto& entries : {manifest.objects, manifest.lights})
    for (const ObjectEntry& one : entries) add(one.name + " " + std::to_string(one.tau_origin));
  add(std::to_string(manifest.light_paths));
  add(manifest.hits_sha256);
  for (const pr::LookInFull& look : looks) {
    add(look.text);
    for (const std::string& file : look.files.named) add(pr::stamp_of_file(file));
    for (const std::string& file : look.files.numbered) add(pr::stamp_if_there(file));
  }
  return hash.digits();
}

class Sequence {
 public:
  Sequence(const PostrenderOptions& options, std::vector<pr::FrameFiles> files)
      : options_(options), files_(std::move(files)), progress_(options, files_.size()) {
    if (!has_number(options.data)) manifest_ = read_manifest(options.data);
  }

  /// Throws InputError where a picture would overwrite a file that a look names.
  void check_inputs() const {
    const pr::PictureNames pictures(files_);
    const pr::FrameFiles* last = nullptr;
    for (const pr::FrameFiles& files : files_) {
      // The same look names the same files.
      const bool same = last != nullptr && files.looks == last->looks && (manifest_ || !files.looks.empty());
      last = &files;
      if (same) continue;
      const Manifest manifest = manifest_ ? *manifest_ : read_manifest(files.data);
      looks_at(read_documents(manifest, files, options_.settings), manifest, files.data, files.frame,
               pictures);
    }
  }

  /// False when it was stopped.
  bool run() {
    std::vector<std::size_t> wanted(files_.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = i;
    // Of one dataset for all frames, only what they need together is read, once.
    std::optional<pr::Renderer> shared;
    if (manifest_) {
      ChannelSet needed;
      std::erase_if(wanted, [&](std::size_t i) {
        if (stop_wanted) return true;
        const Plan plan = plan_of(files_[i]);
        if (plan.there) progress_.skipped(files_[i]);
        if (!plan.there) needed = needed | needed_channels(plan.looks, plan.manifest);
        return plan.there;
      });
      if (wanted.empty()) return !stop_wanted;
      shared.emplace(read_dataset(options_.data, needed, false));
    }
    work_through(wanted, shared ? &*shared : nullptr);
    if (error_) std::rethrow_exception(error_);
    return !stop_wanted;
  }
  void finish(bool whole) { progress_.finish(whole); }

 private:
  Plan plan_of(const pr::FrameFiles& files) const {
    Plan plan;
    plan.manifest = manifest_ ? *manifest_ : read_manifest(files.data);
    std::vector<pr::LookInFull> in_full;
    plan.looks = looks_at(read_documents(plan.manifest, files, options_.settings), plan.manifest, files.data,
                          files.frame, &in_full);
    check_outputs(files.picture, options_.bits, plan.looks);
    plan.fingerprint = fingerprint_of(plan.manifest, in_full, options_.bits);
    std::vector<std::string> inputs = files.looks;
    inputs.push_back(files.data);
    for (const pr::LookInFull& look : in_full) {
      inputs.insert(inputs.end(), look.files.named.begin(), look.files.named.end());
      std::ranges::copy_if(look.files.numbered, std::back_inserter(inputs), [](const std::string& file) {
        std::error_code error;
        return std::filesystem::exists(file, error);
      });
    }
    plan.there = !options_.overwrite && pr::is_newer(files.picture, inputs) &&
                 pr::fingerprint_of_picture(files.picture) == plan.fingerprint;
    return plan;
  }

  /// So many frames at once that all threads have work, and that they fit into half of the memory.
  std::size_t at_once(const std::vector<std::size_t>& wanted, const pr::Renderer* shared) const {
    const Manifest manifest = shared ? shared->manifest() : read_manifest(files_[wanted.front()].data);
    constexpr std::uint64_t kWorking = 80;  // bytes a sample: radiance, developed colours, and their codes
    std::uint64_t bytes = manifest.rays() * kWorking;
    if (!shared) bytes += std::filesystem::file_size(files_[wanted.front()].data);
    const std::uint64_t fit =
        std::max<std::uint64_t>(1, available_memory() / 2 / std::max<std::uint64_t>(1, bytes));
    return std::min(
        {static_cast<std::size_t>(thread_count(options_)), wanted.size(), static_cast<std::size_t>(fit)});
  }

  void work_through(const std::vector<std::size_t>& wanted, const pr::Renderer* shared) {
    const std::size_t workers = at_once(wanted, shared);
    // Frames are independent: each has its share of the threads to itself.
    const int each = std::max(1, thread_count(options_) / static_cast<int>(workers));
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
      tbb::task_arena arena(each);
      arena.execute([&] {
        try {
          std::optional<pr::Renderer> own;
          if (shared) own.emplace(shared->sibling());
          PictureMaker maker(options_.picture, options_.bits);
          for (std::size_t i = next++; i < wanted.size() && !stop_wanted && !failed_; i = next++)
            make(files_[wanted[i]], own ? &*own : nullptr, maker);
        } catch (...) {
          const std::lock_guard lock(mutex_);
          if (!failed_) error_ = std::current_exception();
          failed_ = true;
        }
      });
    };
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < workers; ++i) threads.emplace_back(work);
    work();
  }

  void make(const pr::FrameFiles& files, pr::Renderer* shared, PictureMaker& maker) {
    Stopwatch watch;
    const Plan plan = plan_of(files);
    if (plan.there) return progress_.skipped(files);
    std::optional<pr::Renderer> own;
    if (!shared)
      own.emplace(read_dataset(files.data, needed_channels(plan.looks, plan.manifest), false),
                  *pr::kernels().front(), textures_);
    pr::Renderer& renderer = shared ? *shared : *own;
    const pr::Image& image = maker.make(renderer, plan.looks);
    tell(renderer.notes());
    pr::write_picture(files.picture, image, options_.bits, plan.fingerprint);
    progress_.rendered(files, image, watch.lap());
  }

  /// Each note once.
  void tell(const std::vector<std::string>& notes) {
    const std::lock_guard lock(mutex_);
    for (const std::string& note : notes)
      if (told_.insert(note).second && !options_.common.quiet)
        std::fprintf(stderr, "note: %s\n", note.c_str());
  }

  const PostrenderOptions& options_;
  std::set<std::string> told_;
  std::vector<pr::FrameFiles> files_;
  std::optional<Manifest> manifest_;  ///< where all frames have the same
  std::shared_ptr<pr::TextureCache> textures_ = std::make_shared<pr::TextureCache>();
  SequenceProgress progress_;
  std::mutex mutex_;
  std::atomic<bool> failed_ = false;
  std::exception_ptr error_;
};

void check_movie(const PostrenderOptions& options) {
  if (options.movie.empty()) return;
  check_movie_name(options.movie);
  check_movie_pictures(options.picture);
  find_ffmpeg();
}

}  // namespace

int render_sequence(const PostrenderOptions& options) {
  // Step 1: everything that can be wrong before any work.
  const pr::FramePatterns patterns{options.data, options.looks, options.picture};
  if (!patterns.any()) throw InputError("--frames", "expected #### in DATA, --look or --output");
  std::vector<pr::FrameFiles> files = pr::files_of(patterns, parse_frames(options.frames));
  check_movie(options);
  // Step 2: the pictures.
  catch_stop_signals();
  Sequence sequence(options, files);
  sequence.check_inputs();
  const bool whole = sequence.run();
  sequence.finish(whole);
  if (!whole) return 3;
  // Step 3: the movie.
  if (options.movie.empty()) return 0;
  std::vector<std::string> pictures;
  for (const pr::FrameFiles& one : files) pictures.push_back(one.picture);
  return write_movie(options.movie, pictures, options.fps, stop_wanted) ? 0 : 3;
}

}  // namespace nullcone
