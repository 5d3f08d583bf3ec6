// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::internal {

// A set of postures, by their indices below a number that is given when it is made.
class PostureSet {
 public:
  // Bits that are stored as one.
  static constexpr std::size_t kWordBits = 64;

  PostureSet() = default;
  // None of so many.
  explicit PostureSet(std::size_t count) : words_((count + kWordBits - 1) / kWordBits) {}

  bool contains(std::size_t i) const {
    return (words_[i / kWordBits] >> (i % kWordBits) & 1U) != 0;
  }
  void insert(std::size_t i) { words_[i / kWordBits] |= std::uint64_t{1} << (i % kWordBits); }

  // How many it holds.
  std::size_t size() const {
    std::size_t result = 0;
    for (const std::uint64_t word : words_) result += static_cast<std::size_t>(std::popcount(word));
    return result;
  }

  // Both are sets of the same number of postures.
  PostureSet& operator|=(const PostureSet& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
    return *this;
  }
  PostureSet& operator&=(const PostureSet& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= other.words_[i];
    return *this;
  }
  PostureSet& operator-=(const PostureSet& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= ~other.words_[i];
    return *this;
  }

  // Words of kWordBits postures: threads may insert into different ones at once.
  std::size_t word_count() const { return words_.size(); }
  // Calls `visit` with each index within a word that the set holds, in order.
  template <class Visit>
  void for_each_in_word(std::size_t word, Visit visit) const {
    for (std::uint64_t left = words_[word]; left != 0; left &= left - 1) {
      visit(word * kWordBits + static_cast<std::size_t>(std::countr_zero(left)));
    }
  }
  // Calls `visit` with each index that the set holds, in order.
  template <class Visit>
  void for_each(Visit visit) const {
    for (std::size_t word = 0; word < words_.size(); ++word) for_each_in_word(word, visit);
  }

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace spherule::internal
