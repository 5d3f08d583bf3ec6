// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/link_errors.h"

#include "base/error.h"
#include "base/threads.h"
#include "robot/cover/alarm_sample.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace spherule {
namespace {

using internal::PostureSet;

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

// A link, the E that it may get, the coarsest first, and the covers that are known.
struct ErrorLadder {
  int link = 0;
  std::vector<double> errors{};
  std::vector<std::shared_ptr<const SphereTree>> trees{};  // for each E; null: not covered yet
};

// E from the coarsest to the finest, each finer by the fourth root of 2 than the last one.
std::vector<double> error_steps(double coarsest, double finest) {
  std::vector<double> result;
  for (int n = 0;; ++n) {
    const double error = coarsest * std::pow(2.0, -0.25 * n);
    // A finest E that is a power of the step is reached in spite of rounding.
    if (error < finest * (1.0 - 1e-9)) return result;
    result.push_back(error);
  }
}

// Which step of its ladder each link is at, by the index of the ladder.
using ErrorSteps = std::vector<std::size_t>;
using Limits = std::span<const std::size_t>;

// The search of choose_link_errors(). Its parts are kept by reference.
class ErrorSearch {
 public:
  ErrorSearch(const internal::AlarmJudge& judge, std::vector<ErrorLadder>& ladders,
              const CoverLinks& cover, PairProofs proofs)
      : judge_(judge), ladders_(ladders), cover_(cover), proofs_(proofs) {
    const auto ladder_of = [&](int link) {
      const auto found = std::find_if(ladders_.begin(), ladders_.end(),
                                      [&](const ErrorLadder& l) { return l.link == link; });
      return static_cast<std::size_t>(found - ladders_.begin());
    };
    for (const internal::TestedPair& pair : judge_.pairs()) {
      first_ladder_.push_back(ladder_of(pair.first));
      second_ladder_.push_back(ladder_of(pair.second));
    }
  }

  // The samples of all calls that follow.
  void add_sample(const internal::AlarmSample& sample) {
    Sampled added{&sample, {}, {}};
    for (std::size_t pair = 0; pair < judge_.pairs().size(); ++pair) {
      added.open.push_back(sample.open(pair, proofs_));
    }
    samples_.push_back(std::move(added));
  }

  // Refines from `steps` on until each sample has at most so many refused, and exchanges spheres
  // that do not matter for ones that do. Returns whether it got there; without, all links that
  // would help are at their finest.
  bool run(Limits most_refused, ErrorSteps& steps, const std::function<void(const char*)>& tell) {
    while (!refused(steps, most_refused)) {
      tell("refining links");
      if (!refine(steps)) return false;
    }
    // The steps between those that were taken.
    std::vector<std::pair<std::size_t, std::size_t>> between;
    for (std::size_t ladder = 0; ladder < steps.size(); ++ladder) {
      if (steps[ladder] > 0) between.emplace_back(ladder, steps[ladder] - 1);
    }
    require(between);
    tell("exchanging spheres");
    steps = coarsened(most_refused, steps);
    while (exchange(most_refused, steps)) {
    }
    return true;
  }

  // Of the covers at these steps.
  std::size_t spheres(const ErrorSteps& steps) const {
    std::size_t result = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      result += ladders_[i].trees[steps[i]]->spheres().size();
    }
    return result;
  }

  // Links covered so far, each E counted.
  std::size_t covers() const { return covers_; }

  // Covers what is not covered yet of these (a ladder and a step each, each ladder once).
  void require(std::span<const std::pair<std::size_t, std::size_t>> wanted) {
    std::vector<std::pair<std::size_t, std::size_t>> missing;
    std::vector<LinkError> errors;
    for (const auto& [ladder, step] : wanted) {
      if (ladders_[ladder].trees[step]) continue;
      missing.emplace_back(ladder, step);
      errors.push_back({ladders_[ladder].link, ladders_[ladder].errors[step]});
    }
    if (missing.empty()) return;
    std::vector<std::shared_ptr<const SphereTree>> trees = cover_(errors);
    for (std::size_t i = 0; i < missing.size(); ++i) {
      ladders_[missing[i].first].trees[missing[i].second] = std::move(trees[i]);
    }
    covers_ += missing.size();
  }

 private:
  // Links are refined by so many steps of their ladders at first.
  static constexpr std::size_t kStride = 2;

  // What is known of a sample.
  struct Sampled {
    const internal::AlarmSample* sample = nullptr;
    std::vector<PostureSet> open{};  // of each pair
    // Of a pair with the links at these steps.
    std::map<std::tuple<std::size_t, std::size_t, std::size_t>, PostureSet> alarms{};
  };
  // Among covers that are feasible, which one is gone on with.
  enum class Prefer { kFewestSpheres, kMostSpheresForEachRefusal };

  const PostureSet& alarms(Sampled& in, std::size_t pair, const ErrorSteps& steps) {
    const std::size_t first = first_ladder_[pair];
    const std::size_t second = second_ladder_[pair];
    const auto key = std::tuple(pair, steps[first], steps[second]);
    const auto known = in.alarms.find(key);
    if (known != in.alarms.end()) return known->second;
    const std::span of_first(&ladders_[first].trees[steps[first]], 1);
    const std::span of_second(&ladders_[second].trees[steps[second]], 1);
    return in.alarms.emplace(key, in.sample->overlaps(pair, of_first, of_second, in.open[pair]))
        .first->second;
  }

  // How many postures are refused, summed over the samples; none if there are too many in one.
  std::optional<std::size_t> refused(const ErrorSteps& steps, Limits most_refused) {
    std::size_t result = 0;
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      PostureSet of_sample(samples_[s].sample->free());
      for (std::size_t pair = 0; pair < judge_.pairs().size(); ++pair) {
        of_sample |= alarms(samples_[s], pair, steps);
      }
      const std::size_t count = of_sample.size();
      if (count > most_refused[s]) return std::nullopt;
      result += count;
    }
    return result;
  }

  // All links of pairs that refuse something: which of them could do with coarser spheres shows
  // afterwards, where it is known what all of them do together. One after another, the links that
  // look best early are refined far beyond their worth.
  bool refine(ErrorSteps& steps) {
    std::set<std::pair<std::size_t, std::size_t>> wanted;
    for (Sampled& in : samples_) {
      for (std::size_t pair = 0; pair < judge_.pairs().size(); ++pair) {
        if (alarms(in, pair, steps).size() == 0) continue;
        for (const std::size_t ladder : {first_ladder_[pair], second_ladder_[pair]}) {
          const std::size_t last = ladders_[ladder].errors.size() - 1;
          if (steps[ladder] < last) wanted.emplace(ladder, std::min(steps[ladder] + kStride, last));
        }
      }
    }
    require(std::vector(wanted.begin(), wanted.end()));
    for (const auto& [ladder, step] : wanted) steps[ladder] = step;
    return !wanted.empty();
  }

  bool coarsen_link(Limits most_refused, Prefer prefer, ErrorSteps& steps) {
    const std::size_t spheres_now = spheres(steps);
    const auto refused_now = static_cast<double>(*refused(steps, most_refused));
    double best = 0.0;
    ErrorSteps best_steps;
    for (std::size_t ladder = 0; ladder < ladders_.size(); ++ladder) {
      for (std::size_t step = 0; step < steps[ladder]; ++step) {
        if (!ladders_[ladder].trees[step]) continue;
        ErrorSteps next = steps;
        next[ladder] = step;
        const std::size_t count = spheres(next);
        if (count >= spheres_now) continue;
        const std::optional<std::size_t> refused_then = refused(next, most_refused);
        if (!refused_then) continue;
        const auto saved = static_cast<double>(spheres_now - count);
        const double more = std::max(static_cast<double>(*refused_then) - refused_now, 0.5);
        const double worth = prefer == Prefer::kFewestSpheres ? saved : saved / more;
        if (worth <= best) continue;
        best = worth;
        best_steps = next;
      }
    }
    if (best_steps.empty()) return false;
    steps = best_steps;
    return true;
  }

  ErrorSteps coarsened(Limits most_refused, ErrorSteps steps) {
    ErrorSteps other = steps;
    while (coarsen_link(most_refused, Prefer::kMostSpheresForEachRefusal, steps)) {
    }
    while (coarsen_link(most_refused, Prefer::kFewestSpheres, other)) {
    }
    return spheres(other) < spheres(steps) ? other : steps;
  }

  // Refines a link where it was covered finer already, and makes others coarser for it.
  bool exchange(Limits most_refused, ErrorSteps& steps) {
    for (std::size_t ladder = 0; ladder < ladders_.size(); ++ladder) {
      ErrorSteps next = steps;
      if (++next[ladder] >= ladders_[ladder].errors.size() ||
          !ladders_[ladder].trees[next[ladder]] || !refused(next, most_refused)) {
        continue;
      }
      next = coarsened(most_refused, next);
      if (spheres(next) >= spheres(steps)) continue;
      steps = next;
      return true;
    }
    return false;
  }

  const internal::AlarmJudge& judge_;
  std::vector<ErrorLadder>& ladders_;
  const CoverLinks& cover_;
  PairProofs proofs_;
  std::vector<std::size_t> first_ladder_;  // of each pair
  std::vector<std::size_t> second_ladder_;
  std::vector<Sampled> samples_;
  std::size_t covers_ = 0;
};

std::vector<ErrorLadder> ladders_of(const RobotModel& robot, std::span<const LinkBody> bodies,
                                    const LinkErrorOptions& options) {
  for (const LinkError& fixed : options.fixed) {
    if (std::any_of(bodies.begin(), bodies.end(),
                    [&](const LinkBody& body) { return body.link == fixed.link; })) {
      continue;
    }
    throw Error("link " + std::to_string(fixed.link), "has a max error and nothing to cover");
  }
  std::vector<ErrorLadder> result;
  for (int link = 0; link < static_cast<int>(robot.links().size()); ++link) {
    const auto is_of_link = [&](const auto& x) { return x.link == link; };
    const auto fixed = std::find_if(options.fixed.begin(), options.fixed.end(), is_of_link);
    if (std::none_of(bodies.begin(), bodies.end(), is_of_link)) continue;
    ErrorLadder ladder{.link = link};
    ladder.errors = fixed != options.fixed.end()
                        ? std::vector{fixed->max_error}
                        : error_steps(options.coarsest_error, options.finest_error);
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
  std::vector<ErrorLadder> ladders_;
  const internal::AlarmJudge judge_;
  const CoverLinks& final_covers_;
  ErrorSearch search_;
  ErrorSteps steps_;
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
