// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/internal/edge_proofs.h"

#include <algorithm>

namespace spherule::internal {

void take_between(std::span<const double> from, std::span<const double> to, double at,
                  std::vector<double>& configuration) {
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    configuration[i] = (1.0 - at) * from[i] + at * to[i];
  }
}

EdgeProofs::EdgeProofs(const BodyPairs& pairs)
    : pairs_(pairs),
      begin_(static_cast<std::size_t>(pairs.robot().variable_count())),
      end_(begin_.size()),
      is_free_(pairs.pairs().size()) {}

void EdgeProofs::take(std::span<const double> from, std::span<const double> to) {
  from_ = from;
  to_ = to;
  std::fill(is_free_.begin(), is_free_.end(), std::int8_t{-1});
}

bool EdgeProofs::is_free_at(std::size_t pair, double at) {
  take_between(from_, to_, at, begin_);
  return boxes_of(pair).contains(begin_);
}

bool EdgeProofs::is_free(std::size_t pair) {
  std::int8_t& is_free = is_free_[pair];
  if (is_free < 0) is_free = boxes_of(pair).contains_edge(from_, to_) ? 1 : 0;
  return is_free == 1;
}

}  // namespace spherule::internal
