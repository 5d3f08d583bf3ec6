// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The bodies of an assembly, each covered by itself.

#include "geometry/pose.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "io/sphere_file.h"
#include "simplifier/simplify.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// A body of an assembly, in place: a mesh, or a body before it that is moved rigidly.
struct Body {
  std::string name;
  TriangleMesh mesh;                            // of a copy empty
  std::optional<BodyCopy> copy = std::nullopt;  // `of` names a body that is no copy itself
};

// What fit_bodies() makes of a body.
struct BodyFit {
  std::vector<Sphere> spheres;  // in place
  CertificateRecord certificate;
  std::optional<Simplification> fit;  // of a copy, and where it was stopped before: nothing
  std::string broken;                 // broken_promises(), of a copy those of its original
  double seconds = 0.0;
  bool interrupted = false;  // Simplification::interrupted, or it was stopped before
};

// simplify() of every body by itself, and of copies once: the spheres of a copy are those of its
// original, moved, and grown by no more than rounding costs (by which they may protrude beyond E;
// the certificate has it). Bodies are fitted in parallel, which
// changes no result; each is certified by itself. `options` hold for every body alike; E and D that
// are 0 are chosen for each. `options.progress` tells of all bodies; of a body that is not begun
// when a stop is requested there are no spheres, and its certificate says that it is not covered.
// Throws Error, naming the body, as simplify() does; with the subject "levels" or "zones" where
// these are requested, which are of one body.
std::vector<BodyFit> fit_bodies(std::span<const Body> bodies, const SimplifyOptions& options = {});

// Spheres that hold the given ones after the motion.
std::vector<Sphere> moved_spheres(std::span<const Sphere> spheres, const Pose& pose);

// What a certificate of spheres says of those of moved_spheres(), about the moved solid.
CertificateRecord moved_certificate(const CertificateRecord& certificate,
                                    std::span<const Sphere> spheres, const Pose& pose);

// All bodies in one: their spheres in order, what is proved of all of them together, and a record
// of each. `scales` are those that the bodies were read with.
SphereFile sphere_file(std::span<const Body> bodies, std::span<const BodyFit> fits,
                       std::span<const double> scales);

// What all bodies together are proved to do: they cover if each does, and protrude no further than
// the one that protrudes most.
CertificateRecord joined_certificate(std::span<const BodyRecord> bodies);

}  // namespace spherule
