// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/trajectory_check.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <thread>
#include <utility>
#include <vector>

namespace spherule {
namespace {

class TrajectoryCheck {
 public:
  TrajectoryCheck(const RobotChecker& checker, const Trajectory& trajectory,
                  const TrajectoryCheckOptions& options)
      : checker_(checker),
        trajectory_(trajectory),
        options_(options),
        scratches_(make_scratches(checker, options.threads)),
        places_(places_of(options.configurations_in_all > 0 ? options.configurations_in_all
                                                            : trajectory.size())) {}

  TrajectoryFindings configurations() && {
    std::vector<std::uint8_t> free(trajectory_.size());
    const std::span all(trajectory_.positions);
    in_blocks(free.size(), [&](std::size_t first, std::size_t count) {
      checker_.check_configs(all.subspan(first * trajectory_.width, count * trajectory_.width),
                             scratches_, std::span(free).subspan(first, count));
    });
    count_proved_free();
    for (std::size_t i = 0; i < free.size(); ++i) {
      if (free[i] != 0) continue;
      ++found_.colliding;
      explain(trajectory_.configuration(i), {.line = trajectory_.lines[i]});
    }
    found_.verdicts.free = std::move(free);
    return take();
  }

  TrajectoryFindings motions() && {
    const std::size_t count = std::max<std::size_t>(trajectory_.size(), 1) - 1;
    const std::span all(trajectory_.positions);
    const std::size_t width = trajectory_.width;
    EdgeRequest request = options_.edge;
    request.first = true;
    std::vector<EdgeResult> results;
    in_blocks(count, [&](std::size_t first, std::size_t edges) {
      const std::vector<EdgeResult> some = checker_.check_edges(
          all.subspan(first * width, edges * width),
          all.subspan((first + 1) * width, edges * width), scratches_, request);
      results.insert(results.end(), some.begin(), some.end());
    });
    found_.motions = count;
    count_proved_free();
    found_.colliding = static_cast<std::size_t>(
        std::ranges::count(results, Verdict::kCollision, &EdgeResult::verdict));
    for (std::size_t i = 0; i < count; ++i) {
      if (options_.progress && i % kLeastBlock == 0) {
        options_.progress(static_cast<double>(i) / static_cast<double>(count), "finding contacts");
      }
      if (results[i].verdict == Verdict::kCollision) {
        explain_motion(i, results[i].contact_at);
      } else if (results[i].verdict == Verdict::kUnknown) {
        found_.not_proved.push_back({.line = trajectory_.lines[i],
                                     .to_line = trajectory_.lines[i + 1],
                                     .fraction = results[i].free_until});
      }
    }
    found_.verdicts.motions = std::move(results);
    return take();
  }

 private:
  // So many at a time that the bar moves and the threads have enough to do.
  template <typename Check>
  void in_blocks(std::size_t count, Check check) const {
    const std::size_t block = std::max<std::size_t>(count / 50, kLeastBlock);
    for (std::size_t first = 0; first < count; first += block) {
      if (options_.progress) {
        options_.progress(static_cast<double>(first) / static_cast<double>(count), "checking");
      }
      check(first, std::min(block, count - first));
    }
  }

  void count_proved_free() {
    found_.explained = options_.explained;
    for (std::size_t i = 0; i < found_.explained; ++i) {
      for (const CheckedContact& contact : checker_.explain(
               trajectory_.configuration(i), scratches_.front(), {.proved_free = true})) {
        if (contact.is_proved_free) {
          const FoundContact found{{.line = trajectory_.lines[i]}, contact};
          proved_free_.add(found, found);
        }
      }
    }
  }

  TrajectoryFindings take() {
    found_.pairs = pairs_.take();
    found_.proved_free = proved_free_.take();
    return std::move(found_);
  }

  void explain(std::span<const double> configuration, const TrajectoryPoint& at) {
    for (const CheckedContact& contact : checker_.explain(configuration, scratches_.front())) {
      pairs_.add({at, contact}, {at, contact});
    }
  }

  // Where a motion first touches, and at places on the rest of it: of every two bodies that touch
  // there the first and the deepest contact.
  void explain_motion(std::size_t motion, double contact_at) {
    std::vector<std::pair<FoundContact, FoundContact>> found;
    PairIndex index;
    for (std::size_t k = 0; k <= places_; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(places_);
      const TrajectoryPoint at{.line = trajectory_.lines[motion],
                               .to_line = trajectory_.lines[motion + 1],
                               .fraction = contact_at + share * (1.0 - contact_at)};
      const std::vector<double> configuration = checker_.configuration_on_edge(
          trajectory_.configuration(motion), trajectory_.configuration(motion + 1), at.fraction,
          options_.edge.continuous);
      for (const CheckedContact& contact : checker_.explain(configuration, scratches_.front())) {
        const FoundContact here{at, contact};
        const auto known = index.find_or_add(contact, found.size());
        if (!known) {
          found.emplace_back(here, here);
        } else if (FoundContact& deepest = found[*known].second;
                   contact.overlap_depth > deepest.contact.overlap_depth) {
          deepest = here;
        }
      }
    }
    for (const auto& [first, deepest] : found) pairs_.add(first, deepest);
  }

  // How many places of a motion are searched: 24, of trajectories of more than 1,666 configurations
  // fewer, so that this takes a fraction of a second, but at least 4.
  static std::size_t places_of(std::size_t configurations) {
    constexpr std::size_t kInAll = 40000;
    return std::clamp<std::size_t>(kInAll / std::max<std::size_t>(configurations, 1), 4, 24);
  }

  static constexpr std::size_t kLeastBlock = 256;

  const RobotChecker& checker_;
  const Trajectory& trajectory_;
  const TrajectoryCheckOptions& options_;
  std::vector<RobotChecker::Scratch> scratches_;
  const std::size_t places_;
  TrajectoryFindings found_;
  PairCounter pairs_;
  PairCounter proved_free_;
};

}  // namespace

std::vector<RobotChecker::Scratch> make_scratches(const RobotChecker& checker, int threads) {
  const unsigned count = threads > 0 ? static_cast<unsigned>(threads)
                                     : std::max(1u, std::thread::hardware_concurrency());
  std::vector<RobotChecker::Scratch> scratches;
  for (unsigned i = 0; i < count; ++i) scratches.emplace_back(checker);
  return scratches;
}

TrajectoryFindings check_configurations(const RobotChecker& checker, const Trajectory& trajectory,
                                        const TrajectoryCheckOptions& options) {
  return TrajectoryCheck(checker, trajectory, options).configurations();
}

TrajectoryFindings check_motions(const RobotChecker& checker, const Trajectory& trajectory,
                                 const TrajectoryCheckOptions& options) {
  return TrajectoryCheck(checker, trajectory, options).motions();
}

}  // namespace spherule
