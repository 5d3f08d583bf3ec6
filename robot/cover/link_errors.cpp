// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/link_errors.h"

#include "robot/cover/internal/alarm_counts.h"
#include "robot/cover/internal/error_search.h"
#include "robot/model/internal/shared_work.h"
#include "spheretree/error.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace spherule {
namespace {

constexpr int kAttempts = 4;
// What the search may use up of the goal, and of that at most after a verification that failed.
constexpr double kReserve = 0.95;
constexpr double kConfidenceOfAttempt = 1.0 - (1.0 - LinkErrorChoice::kConfidence) / kAttempts;

void check(const LinkErrorOptions& options) {
  const auto require = [](bool ok, const char* subject, const char* what) {
    if (!ok) throw Error(subject, what);
  };
  require(options.goal > 0.0 && options.goal < 1.0, "share of false alarms",
          "must be above 0 and below 1");
  require(options.finest_error > 0.0 && std::isfinite(options.coarsest_error), "max error",
          "must be positive and finite");
  require(options.finest_error <= options.coarsest_error, "max error",
          "the coarsest one is below the finest one");
  require(options.sample.postures > 0, "postures", "there are none");
}

std::vector<internal::ErrorLadder> ladders_of(const RobotModel& robot,
                                              std::span<const LinkBody> bodies,
                                              const LinkErrorOptions& options) {
  for (const LinkError& fixed : options.fixed) {
    if (std::any_of(bodies.begin(), bodies.end(),
                    [&](const LinkBody& body) { return body.link == fixed.link; })) {
      continue;
    }
    throw Error("link " + std::to_string(fixed.link), "has a max error and nothing to cover");
  }
  std::vector<internal::ErrorLadder> result;
  for (int link = 0; link < static_cast<int>(robot.links().size()); ++link) {
    const auto is_of_link = [&](const auto& x) { return x.link == link; };
    const auto fixed = std::find_if(options.fixed.begin(), options.fixed.end(), is_of_link);
    if (std::none_of(bodies.begin(), bodies.end(), is_of_link)) continue;
    internal::ErrorLadder ladder{.link = link};
    ladder.errors = fixed != options.fixed.end()
                        ? std::vector{fixed->max_error}
                        : internal::error_steps(options.coarsest_error, options.finest_error);
    ladder.trees.resize(ladder.errors.size());
    result.push_back(std::move(ladder));
  }
  return result;
}

// The most postures of so many free ones that are at most such a share of them.
std::size_t most_of(std::size_t free, double share) {
  return static_cast<std::size_t>(share * static_cast<double>(free));
}

// One call of choose_link_errors().
class Choice {
 public:
  Choice(const RobotModel& robot, std::span<const LinkBody> bodies,
         const AllowedCollisions& allowed, const LinkPairs* proofs, const CoverLinks& search_covers,
         const CoverLinks& final_covers, const LinkErrorOptions& options)
      : options_(options),
        ladders_(ladders_of(robot, bodies, options)),
        judge_(robot, bodies, allowed, proofs,
               [this](int link) {
                 return std::any_of(ladders_.begin(), ladders_.end(),
                                    [&](const auto& l) { return l.link == link; });
               }),
        final_covers_(final_covers),
        search_(judge_, ladders_, search_covers, options.sample.proofs),
        steps_(ladders_.size(), 0) {
    std::vector<std::pair<std::size_t, std::size_t>> coarsest;
    for (std::size_t i = 0; i < ladders_.size(); ++i) coarsest.emplace_back(i, 0);
    search_.require(coarsest);
  }

  LinkErrorChoice make() {
    const internal::LinkTrees coarsest = trees(searched());
    const internal::AlarmSample random = sample(coarsest, options_.sample.seed);
    std::optional<internal::AlarmSample> given;
    search_.add_sample(random);
    if (!options_.given.empty()) {
      given.emplace(sample(coarsest, options_.given));
      search_.add_sample(*given);
    }
    LinkErrorChoice result;
    result.coarsest = internal::count_alarms(judge_, random, coarsest, options_.sample);
    result.coarsest_spheres = search_.spheres(steps_);
    double reserve = kReserve;
    double reserve_of_given = 1.0;
    for (int attempt = 0; attempt < kAttempts && !result.is_reached; ++attempt) {
      std::vector<std::size_t> limits = {most_of(random.free(), options_.goal * reserve)};
      if (given) limits.push_back(most_of(given->free(), options_.goal * reserve_of_given));
      const bool is_found = search_.run(limits, steps_, [&](const char* what) { tell(what); });
      verify(static_cast<std::uint64_t>(attempt), given, result);
      if (!is_found) break;
      // By as much as the choice was better in the sample that it was made by.
      if (result.upper_bound > options_.goal) {
        reserve *= std::min(kReserve, options_.goal / result.upper_bound);
      } else {
        reserve_of_given *= kReserve;
      }
    }
    result.covers = search_.covers();
    return result;
  }

 private:
  using Covers = std::vector<std::shared_ptr<const SphereTree>>;  // of each ladder

  Covers searched() const {
    Covers result;
    for (std::size_t i = 0; i < ladders_.size(); ++i) {
      result.push_back(ladders_[i].trees[steps_[i]]);
    }
    return result;
  }

  Covers finished() const {
    if (!final_covers_) return searched();
    std::vector<LinkError> errors;
    for (std::size_t i = 0; i < ladders_.size(); ++i) {
      errors.push_back({ladders_[i].link, ladders_[i].errors[steps_[i]]});
    }
    return final_covers_(errors);
  }

  internal::LinkTrees trees(const Covers& covers) const {
    internal::LinkTrees result(judge_.robot().links().size());
    for (std::size_t i = 0; i < ladders_.size(); ++i) {
      result[static_cast<std::size_t>(ladders_[i].link)].push_back(covers[i]);
    }
    return result;
  }

  internal::AlarmSample sample(const internal::LinkTrees& trees,
                               std::vector<double> postures) const {
    return {judge_, trees, std::move(postures), internal::thread_count(options_.sample.threads),
            [this](double share) {
              if (options_.sample.progress) options_.sample.progress(share, "postures");
            }};
  }
  internal::AlarmSample sample(const internal::LinkTrees& trees, std::uint64_t seed) const {
    return sample(trees, internal::draw_postures(judge_.robot(), options_.sample.postures, seed));
  }

  void tell(const char* what) const {
    if (options_.sample.progress) options_.sample.progress(-1.0, what);
  }

  // By postures that no earlier attempt has seen.
  void verify(std::uint64_t attempt, const std::optional<internal::AlarmSample>& given,
              LinkErrorChoice& result) const {
    const Covers covers = finished();
    const internal::LinkTrees of_links = trees(covers);
    result.verified = {.proofs = options_.sample.proofs};
    for (std::uint64_t part = 0; part < LinkErrorChoice::kVerification; ++part) {
      const std::uint64_t seed =
          options_.sample.seed + 1 + attempt * LinkErrorChoice::kVerification + part;
      internal::add(
          internal::count_alarms(judge_, sample(of_links, seed), of_links, options_.sample),
          result.verified);
    }
    result.upper_bound = result.verified.refused_share().upper_bound(kConfidenceOfAttempt);
    result.is_reached = result.upper_bound <= options_.goal;
    if (given) {
      result.given = internal::count_alarms(judge_, *given, of_links, options_.sample);
      result.is_reached = result.is_reached && result.given.refused_share().refused <=
                                                   most_of(given->free(), options_.goal);
    }
    result.links.clear();
    result.spheres = 0;
    for (std::size_t i = 0; i < ladders_.size(); ++i) {
      const std::size_t spheres = covers[i]->spheres().size();
      result.links.push_back({ladders_[i].link, ladders_[i].errors[steps_[i]], spheres});
      result.spheres += spheres;
    }
  }

  const LinkErrorOptions& options_;
  std::vector<internal::ErrorLadder> ladders_;
  const internal::AlarmJudge judge_;
  const CoverLinks& final_covers_;
  internal::ErrorSearch search_;
  internal::ErrorSteps steps_;
};

}  // namespace

LinkErrorChoice choose_link_errors(const RobotModel& robot, std::span<const LinkBody> bodies,
                                   const AllowedCollisions& allowed, const LinkPairs* proofs,
                                   const CoverLinks& search_covers, const CoverLinks& final_covers,
                                   const LinkErrorOptions& options) {
  check(options);
  return Choice(robot, bodies, allowed, proofs, search_covers, final_covers, options).make();
}

}  // namespace spherule
