// Crossings that a search has found, before anything is written about them.
#pragma once

#include <cstdint>
#include <memory>

#include "core/base/isa.h"

NULLCONE_KERNEL_BEGIN

/// A list that grows. (Standard containers would bring code that instruction sets share.)
template <class T>
class Pool {
 public:
  explicit Pool(std::size_t room) : room_(room < 16 ? 16 : room), items_(new T[room_]) {}

  void push(const T& item) {
    if (size_ == room_) {
      std::unique_ptr<T[]> larger(new T[2 * room_]);
      for (std::size_t i = 0; i < size_; ++i) larger[i] = items_[i];
      items_.swap(larger);
      room_ *= 2;
    }
    items_[size_++] = item;
  }
  std::size_t size() const { return size_; }
  const T& operator[](std::size_t i) const { return items_[i]; }
  T& operator[](std::size_t i) { return items_[i]; }

 private:
  std::size_t room_, size_ = 0;
  std::unique_ptr<T[]> items_;
};

/// Where a ray met an object, to the precision of a search.
struct Crossing {
  std::uint32_t ray, number;  ///< the object's (or the sky's) from 1
  double lambda;
};

/// The same crossings ray by ray, for rays 0 … count - 1; those of one ray keep their order.
template <class T>
Pool<T> by_ray(const Pool<T>& found, std::size_t count) {
  const std::unique_ptr<std::uint32_t[]> next(new std::uint32_t[count + 1]());
  for (std::size_t i = 0; i < found.size(); ++i) ++next[found[i].ray + 1];
  for (std::size_t ray = 0; ray < count; ++ray) next[ray + 1] += next[ray];
  Pool<T> out(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) out.push(found[i]);  // room for all of them
  for (std::size_t i = 0; i < found.size(); ++i) out[next[found[i].ray]++] = found[i];
  return out;
}

NULLCONE_KERNEL_END
