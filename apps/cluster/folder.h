// The folder of a sequence: what lies where in it. docs/cluster.md lists the names.
#pragma once

#include <string>

namespace nullcone::cluster {

class Folder {
 public:
  /// Made absolute. Throws InputError for a name that cannot stand in patterns of names (with # or line
  /// ends).
  explicit Folder(const std::string& path);

  const std::string& path() const { return path_; }
  std::string scene() const { return path_ + "/scene.json"; }
  std::string look() const { return path_ + "/look.json"; }
  /// The pattern of whole frames; and of their pictures.
  std::string data() const { return path_ + "/data.####.exr"; }
  std::string pictures() const { return path_ + "/pictures/####.png"; }

  /// Of bookkeeping: "lock", "failed.txt".
  std::string cluster(const std::string& name) const { return path_ + "/cluster/" + name; }
  /// Of a round, as "001.plan.json".
  std::string round(int number, const std::string& name) const;
  /// Of a bundle of a round, as "001/7.log".
  std::string bundle(int round, const std::string& name) const;

  /// Of the rounds that were planned; 0 for none.
  int last_round() const;
  /// The folders of datasets and bookkeeping, and for a round from 1 on also that of its bundles. Throws
  /// WorkError.
  void create(int round = 0) const;

 private:
  std::string path_;
};

/// Throws InputError for a folder in which nothing was submitted.
void refuse_unknown(const Folder& folder);

/// Writes a text whole or not at all. Throws WorkError.
void write_text(const std::string& path, const std::string& text);
/// Empty where it cannot be read.
std::string read_text(const std::string& path);
/// When it was changed, in seconds since 1970; 0 where it is not there.
double modified(const std::string& path);
/// Seconds since 1970.
double now();
/// The folder and name of the program that runs, for its companions: "…/bin".
std::string program_folder();

}  // namespace nullcone::cluster
