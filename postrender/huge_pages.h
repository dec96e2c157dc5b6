// Memory for what is read in no order: large pages, so that addresses are found without walking page tables.
#pragma once

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace nullcone::postrender {

/// Like std::allocator; blocks of some MiB are asked of the system in pages of 2 MiB, which it may refuse.
template <class T>
struct HugePageAllocator {
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t{2} << 20;

  HugePageAllocator() = default;
  template <class U>
  HugePageAllocator(const HugePageAllocator<U>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < 2 * kPage) return static_cast<T*>(::operator new (bytes, std::align_val_t{64}));
    const std::size_t whole = (bytes + kPage - 1) / kPage * kPage;
    void* out = std::aligned_alloc(kPage, whole);
    if (out == nullptr) throw std::bad_alloc();
    ::madvise(out, whole, MADV_HUGEPAGE);
    return static_cast<T*>(out);
  }
  void deallocate(T* block, std::size_t count) {
    if (count * sizeof(T) < 2 * kPage) {
      ::operator delete (block, std::align_val_t{64});
    } else {
      std::free(block);
    }
  }
  template <class U>
  bool operator==(const HugePageAllocator<U>&) const {
    return true;
  }
};

}  // namespace nullcone::postrender
