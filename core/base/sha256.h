// SHA-256, by OpenSSL: fingerprints of scenes and payloads.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace nullcone {

/// A running SHA-256. Feed any number of blocks, then take the 64 hexadecimal digits once.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::span<const std::byte> bytes);
  template <class T>
  void add(std::span<const T> values) {
    add(std::as_bytes(values));
  }
  void add(std::string_view text) { add(std::as_bytes(std::span(text))); }
  std::string digits();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

std::string sha256(std::string_view text);

}  // namespace nullcone
