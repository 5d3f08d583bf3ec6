// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/bodies.h"

#include "base/error.h"
#include "base/rounding.h"
#include "base/stopwatch.h"
#include "base/threads.h"
#include "simplifier/option_record.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <numeric>
#include <utility>

namespace spherule {
namespace {

// By how far moving the centre of a sphere may miss: Pose::operator* proves 40 u (|c| + |t|).
double moving_error(const Sphere& sphere, const Pose& pose) {
  const double size = add_up(norm_upper(sphere.center), norm_upper(pose.translation()));
  return mul_up(size, 40.0 * kUnitRoundoff);
}

void check(std::span<const Body> bodies, const SimplifyOptions& options) {
  if (!options.zones.empty()) throw Error("zones", "are of one body, not of several");
  if (!options.levels.empty()) throw Error("levels", "are of one body, not of several");
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::optional<BodyCopy>& copy = bodies[i].copy;
    if (copy && (copy->of >= i || bodies[copy->of].copy)) {
      throw Error(bodies[i].name, "is no copy of a body before it");
    }
  }
}

// Fits the bodies that are no copies.
class Fitter {
 public:
  Fitter(std::span<const Body> bodies, const SimplifyOptions& options)
      : bodies_(bodies), options_(options), fits_(bodies.size()), faults_(bodies.size()) {
    options_.progress = {};
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (!bodies[i].copy) order_.push_back(i);
    }
    // Those that take longest are begun first.
    std::ranges::stable_sort(order_, std::greater{},
                             [&](std::size_t i) { return bodies_[i].mesh.triangles.size(); });
    progress_ = options.progress;
  }

  std::vector<BodyFit> run() {
    const internal::ThreadLimit threads(options_.threads);
    if (progress_) progress_(0.0, "fitting bodies");
    // A worker takes the next body when it is done with one; idle threads help with the loops
    // inside of a body.
    tbb::parallel_for(
        std::size_t{0}, std::min(order_.size(), kMostAtATime), [&](std::size_t) { work(); },
        tbb::simple_partitioner());
    for (const std::exception_ptr& fault : faults_) {
      if (fault) std::rethrow_exception(fault);
    }
    return std::move(fits_);
  }

 private:
  static constexpr std::size_t kMostAtATime = 256;

  void work() {
    for (;;) {
      const std::size_t next = next_++;
      if (next >= order_.size() || failed_ || options_.stop.stop_requested()) return;
      const std::size_t body = order_[next];
      try {
        // While a loop inside waits, its thread must not begin another body.
        tbb::this_task_arena::isolate([&] { fit(body); });
      } catch (...) {
        faults_[body] = std::current_exception();
        failed_ = true;
      }
      tell();
    }
  }

  void fit(std::size_t body) {
    const internal::Stopwatch watch;
    BodyFit& result = fits_[body];
    try {
      result.fit = simplify(bodies_[body].mesh, options_);
    } catch (const Error& error) {
      throw Error(bodies_[body].name, error.what());
    }
    result.spheres = result.fit->cover.spheres;
    result.certificate = record(result.fit->certificate);
    result.broken = broken_promises(*result.fit);
    result.seconds = watch.seconds();
    result.interrupted = result.fit->interrupted;
  }

  void tell() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (!progress_) return;
    progress_(static_cast<double>(done_) / static_cast<double>(order_.size()), "fitting bodies");
  }

  std::span<const Body> bodies_;
  SimplifyOptions options_;
  Progress progress_;
  std::vector<std::size_t> order_;
  std::vector<BodyFit> fits_;
  std::vector<std::exception_ptr> faults_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;
  std::size_t done_ = 0;
};

void place_copy(const BodyCopy& copy, const BodyFit& original, BodyFit& placed) {
  placed.spheres = moved_spheres(original.spheres, copy.pose);
  placed.certificate = moved_certificate(original.certificate, original.spheres, copy.pose);
  placed.broken = original.broken;
  placed.interrupted = original.interrupted;
}

void mark_unfitted(BodyFit& fit) {
  fit.certificate.uncovered_depth_upper = std::numeric_limits<double>::infinity();
  fit.broken = "no spheres: the work was interrupted before";
  fit.interrupted = true;
}

}  // namespace

std::vector<BodyFit> fit_bodies(std::span<const Body> bodies, const SimplifyOptions& options) {
  check(bodies, options);
  std::vector<BodyFit> fits = Fitter(bodies, options).run();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::optional<BodyCopy>& copy = bodies[i].copy;
    if (copy && fits[copy->of].fit) {
      place_copy(*copy, fits[copy->of], fits[i]);
    } else if (!fits[i].fit) {
      mark_unfitted(fits[i]);
    }
  }
  return fits;
}

std::vector<Sphere> moved_spheres(std::span<const Sphere> spheres, const Pose& pose) {
  std::vector<Sphere> moved;
  moved.reserve(spheres.size());
  for (const Sphere& sphere : spheres) {
    moved.push_back({pose * sphere.center, add_up(sphere.radius, moving_error(sphere, pose))});
  }
  return moved;
}

CertificateRecord moved_certificate(const CertificateRecord& certificate,
                                    std::span<const Sphere> spheres, const Pose& pose) {
  double error = 0.0;
  for (const Sphere& sphere : spheres) error = std::max(error, moving_error(sphere, pose));
  // A sphere reaches beyond the exactly moved one by the error of its centre and by what its radius
  // grew: the error again, and the rounding of the sum.
  double largest = 0.0;
  for (const Sphere& sphere : spheres) largest = std::max(largest, sphere.radius);
  const double inflation = add_up(mul_up(2.0, error), mul_up(largest, 8.0 * kUnitRoundoff));
  CertificateRecord moved = certificate;
  // The moved spheres hold the exactly moved ones, so that no depth is larger.
  moved.uncovered_depth_lower =
      std::max(0.0, sub_down(certificate.uncovered_depth_lower, inflation));
  for (std::optional<double>* protrusion :
       {&moved.protrusion_over_simplified_max, &moved.protrusion_over_mesh_max}) {
    if (*protrusion) **protrusion = add_up(**protrusion, inflation);
  }
  return moved;
}

SphereFile sphere_file(std::span<const Body> bodies, std::span<const BodyFit> fits,
                       std::span<const double> scales) {
  SphereFile file;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodyFit& fit = fits[i];
    file.spheres.insert(file.spheres.end(), fit.spheres.begin(), fit.spheres.end());
    BodyRecord body{.name = bodies[i].name,
                    .sphere_count = fit.spheres.size(),
                    .certificate = fit.certificate,
                    .options = {},
                    .copy = bodies[i].copy,
                    .interrupted = fit.interrupted};
    file.interrupted = file.interrupted || fit.interrupted;
    if (fit.fit) body.options = option_record(fit.fit->options, scales[i]);
    file.bodies.push_back(std::move(body));
  }
  file.certificate = joined_certificate(file.bodies);
  return file;
}

CertificateRecord joined_certificate(std::span<const BodyRecord> bodies) {
  CertificateRecord joined{.covered = !bodies.empty()};
  bool all_protrude = !bodies.empty();
  double protrusion = 0.0;
  for (const BodyRecord& body : bodies) {
    joined.sphere_count += body.sphere_count;
    const CertificateRecord none{.uncovered_depth_upper = std::numeric_limits<double>::infinity()};
    const CertificateRecord& own = body.certificate ? *body.certificate : none;
    joined.covered = joined.covered && own.covered;
    // What one body's spheres leave may lie in those of another: below there is no bound but 0.
    joined.uncovered_depth_upper =
        std::max(joined.uncovered_depth_upper, own.uncovered_depth_upper);
    all_protrude = all_protrude && own.protrusion_over_simplified_max.has_value();
    protrusion = std::max(protrusion, own.protrusion_over_simplified_max.value_or(0.0));
  }
  if (all_protrude) joined.protrusion_over_simplified_max = protrusion;
  return joined;
}

}  // namespace spherule
