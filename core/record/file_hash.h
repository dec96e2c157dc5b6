// The hash by which a dataset file vouches for every one of its bytes: SHA-256 over the digits of the SHA-256
// of each MiB of the file (so that many threads can work on it), with zeros in the place of its own 64
// digits.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace nullcone {

/// Where the digits stand in the header of an open file; nothing if there are none.
std::optional<std::uint64_t> find_file_hash(int descriptor);
/// The digits that stand there.
std::string stored_file_hash(int descriptor, std::uint64_t place);
/// What they should be. `threads`: 0 for one a core.
std::string compute_file_hash(int descriptor, std::uint64_t place, unsigned threads = 0);

/// Where `text` stands in the first `within` bytes of an open file.
std::optional<std::uint64_t> find_text(int descriptor, std::string_view text, std::uint64_t within);

}  // namespace nullcone
