/// @file
/// A queue of bounded length.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace leeway {

/// Oldest first. Allocates at construction and when copied, never after.
template <class T>
class RingBuffer {
 public:
  /// @param filler  what unused room holds; T need not have a default. @pre capacity > 0.
  RingBuffer(std::size_t capacity, const T& filler) : data_(capacity, filler) {}

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return data_.size(); }
  bool empty() const { return size_ == 0; }
  bool full() const { return size_ == data_.size(); }

  /// @pre k < size().
  T& operator[](std::size_t k) { return data_[(first_ + k) % data_.size()]; }
  const T& operator[](std::size_t k) const { return data_[(first_ + k) % data_.size()]; }
  const T& front() const { return (*this)[0]; }
  T& front() { return (*this)[0]; }
  T& back() { return (*this)[size_ - 1]; }
  const T& back() const { return (*this)[size_ - 1]; }

  /// One element more at the end, which holds whatever was there before. @pre not full().
  T& extend() { return data_[(first_ + size_++) % data_.size()]; }

  void push_back(const T& value) { extend() = value; }

  /// Before the element k. @pre not full(), k <= size().
  void insert(std::size_t k, const T& value) {
    push_back(value);
    for (std::size_t i = size_ - 1; i > k; --i) std::swap((*this)[i], (*this)[i - 1]);
  }

  /// @pre not empty().
  void pop_front() {
    first_ = (first_ + 1) % data_.size();
    --size_;
  }
  void pop_back() { --size_; }
  void clear() { size_ = 0; }

  /// Every element there is room for, so that the size in a snapshot does not change.
  template <class Archive>
  void visit(Archive& archive) {
    archive(size_);
    if constexpr (Archive::kReads) first_ = 0;
    T filler{};
    for (std::size_t k = 0; k < capacity(); ++k) archive(k < size_ ? (*this)[k] : filler);
  }

 private:
  std::vector<T> data_;
  std::size_t first_{0};
  std::size_t size_{0};
};

}  // namespace leeway
