// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/proof/proof.h"
#include "simplifier/support/best_first.h"
#include "simplifier/support/parallel.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace spherule::internal {

// What was found out about a piece of the set X to be covered.
struct Finding {
  bool settled = false;   // what X is in it is in a single sphere: nothing remains to be proved
  bool smallest = false;  // not to be split further
  double upper = 0.0;     // no point of X in the piece is further from the spheres
  double depth = -std::numeric_limits<double>::infinity();  // of `point`, if that is in X
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

// Proves the coverage of X (G1), given as pieces, by splitting what `examine` leaves open with
// `split` (which appends the parts of a piece to a list). Only points for which `is_witness` is
// true are reported. All three are called by several threads. A piece that is proved not to be
// deeper than the deepest point found, within `finest` or kDepthTolerance of that depth, is left as
// it is: it does not change the verdict, nor the depth by more than that. The first kCloserPieces
// are split on to a tenth of these tolerances, which leaks of simple shapes reach.
//
// The deepest pieces are examined first, so that a leak is soon known; what remains after
// kBestFirst pieces is divided into fixed blocks for the threads, so that the result does not
// depend on their number.
template <typename Piece, typename Examine, typename Split, typename IsWitness>
class Subdivision {
 public:
  Subdivision(std::vector<Piece> pieces, double finest, Examine examine, Split split,
              IsWitness is_witness)
      : pieces_(std::move(pieces)),
        finest_(finest),
        examine_(std::move(examine)),
        split_(std::move(split)),
        is_witness_(std::move(is_witness)) {}

  CoverageProof prove(const KnownLeak& known = {}) const {
    State state{{.lower = known.depth, .deepest = known.point}, known.depth};
    std::vector<Open> heap;
    std::uint64_t made = 0;
    for (const Piece& piece : pieces_) {
      heap.push_back({piece, std::numeric_limits<double>::infinity(), made++});
    }
    std::make_heap(heap.begin(), heap.end(), BestFirst());
    std::vector<Piece> parts;
    while (!heap.empty() && state.proof.examined < std::max(kBestFirst, 2 * pieces_.size())) {
      std::pop_heap(heap.begin(), heap.end(), BestFirst());
      const Open open = std::move(heap.back());
      heap.pop_back();
      double upper = open.upper;
      const bool is_early = state.proof.examined < kCloserPieces + pieces_.size();
      if (!step(open.piece, state, is_early ? kCloserShare : 1.0, upper, parts)) continue;
      for (const Piece& part : parts) {
        heap.push_back({part, upper, made++});
        std::push_heap(heap.begin(), heap.end(), BestFirst());
      }
    }
    std::sort(heap.begin(), heap.end(), BestFirst());
    prove_in_blocks(heap, state);
    return state.proof;
  }

 private:
  static constexpr std::size_t kBestFirst = 20'000;
  static constexpr std::size_t kBlocks = 64;
  static constexpr double kDepthTolerance = 0.02;
  static constexpr double kCloserShare = 0.1;
  static constexpr std::size_t kCloserPieces = 4'000;

  struct Open {
    Piece piece;
    double upper;
    std::uint64_t order;
  };
  struct State {
    CoverageProof proof;
    double seen = 0.0;  // greatest depth met, whether or not its point may be reported
  };

  // Examines one piece; true if it was split into `parts`. `share` multiplies the tolerances.
  bool step(const Piece& piece, State& state, double share, double& upper,
            std::vector<Piece>& parts) const {
    ++state.proof.examined;
    Piece open = piece;
    const Finding found = examine_(open);
    if (found.settled) return false;
    if (found.depth > state.seen) state.seen = found.depth;
    if (found.depth > state.proof.lower && is_witness_(found.point)) {
      state.proof.lower = found.depth;
      state.proof.deepest = found.point;
    }
    upper = std::min(upper, std::max(0.0, found.upper));
    const double close = share * std::max(finest_, kDepthTolerance * state.seen);
    if (found.smallest || (state.seen > 0.0 && upper <= state.seen + close)) {
      state.proof.upper = std::max({state.proof.upper, upper, kUnderflow});
      return false;
    }
    parts.clear();
    split_(open, parts);
    return true;
  }

  void prove_in_blocks(const std::vector<Open>& open, State& state) const {
    State start = state;
    start.proof.examined = 0;
    std::vector<State> states(std::min(kBlocks, open.size()), start);
    parallel_for(0, states.size(), [&](std::size_t block) {
      std::vector<std::pair<Piece, double>> waiting;
      std::vector<Piece> parts;
      for (std::size_t i = block; i < open.size(); i += states.size()) {
        waiting.assign(1, {open[i].piece, open[i].upper});
        while (!waiting.empty()) {
          auto [piece, upper] = std::move(waiting.back());
          waiting.pop_back();
          if (!step(piece, states[block], 1.0, upper, parts)) continue;
          for (const Piece& part : parts) waiting.emplace_back(part, upper);
        }
      }
    });
    for (const State& s : states) state.proof.join(s.proof);
  }

  std::vector<Piece> pieces_;
  double finest_;
  Examine examine_;
  Split split_;
  IsWitness is_witness_;
};

}  // namespace spherule::internal
