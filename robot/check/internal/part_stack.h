// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace spherule::internal {

// Parts of a motion that wait, the one to be evaluated next on top, each with the tests that are
// open in it.
class PartStack {
 public:
  struct Part {
    double begin;
    double end;
  };

  bool empty() const { return parts_.empty(); }

  // `words` hold the set of tests of a part.
  void clear(std::size_t words) {
    words_ = words;
    parts_.clear();
    open_.clear();
  }

  // `open` is a set of tests.
  void push(const Part& part, const std::uint64_t* open) {
    parts_.push_back(part);
    open_.insert(open_.end(), open, open + words_);
  }
  void pop(Part& part, std::uint64_t* open) {
    part = parts_.back();
    parts_.pop_back();
    std::copy(open_.end() - static_cast<std::ptrdiff_t>(words_), open_.end(), open);
    open_.resize(open_.size() - words_);
  }

  // The earliest begin of those that wait; infinite if there is none.
  double earliest() const {
    double result = std::numeric_limits<double>::infinity();
    for (const Part& part : parts_) result = std::min(result, part.begin);
    return result;
  }

 private:
  std::size_t words_ = 0;
  std::vector<Part> parts_;
  std::vector<std::uint64_t> open_;
};

}  // namespace spherule::internal
