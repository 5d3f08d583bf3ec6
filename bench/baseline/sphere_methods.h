// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"
#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Methods of comparison that make spheres of a mesh, and whether each is conservative.

namespace spherule {

// Which cells of space a method takes.
enum class Filling {
  kSolid,   // those that the surface intersects and those inside
  kSurface  // those that the surface intersects
};

// Spheres of any method, grown until they cover.

// A set of spheres grown until it covers, and what is proved about it.
struct ConservativeSpheres {
  std::vector<Sphere> spheres;  // the same centres in the same order
  double inflation = 0.0;       // of every radius; 0 if the spheres cover as they are
  Certificate certificate;      // of the grown spheres, against |M|
};

// Conservative. Grows every radius by the proved upper bound of the uncovered depth of |M| grown by
// `padding` and the mesh's vertex_error (certify() without external spheres: a hollow whose way in
// is narrower than 1/128 of the box diagonal counts as solid), and by 1/4096 of the diagonal, with
// which the second proof succeeds. Then every point of it is in a sphere: one at distance d from
// the nearest sphere is in that sphere grown by d. The certificate is that of a second search, on
// the spheres returned. Lengths in the unit of the mesh. On at most `threads` threads, 0: all; the
// result is the same. Throws Error if there is no sphere, if one is not usable or cannot grow any
// more, for a mesh that validate() refuses and for a padding out of range.
ConservativeSpheres made_conservative(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                                      double padding = 0.0, int threads = 0,
                                      const Progress& progress = {});

// A sphere for each voxel: conservative with circumscribed spheres.

// The sphere that stands for a voxel.
enum class VoxelSphere {
  kCircumscribed,  // around the cube, of diameter sqrt(3) times the step: contains it
  kInscribed       // of the cube's width, as the paper has it: leaves its corners out
};

// How fine voxels are, and what stands for one.
struct VoxelisationOptions {
  // Edge of a voxel, in the unit of the mesh; or 0, and max_error says how large it may be.
  double step = 0.0;
  // E: the step is a thousandth below E / sqrt(3), so that no point of a circumscribed sphere is
  // further than E from its voxel's part of M or, where that is inside, from |M|.
  double max_error = 0.0;
  VoxelSphere sphere = VoxelSphere::kCircumscribed;
  Filling filling = Filling::kSolid;
  // t: voxels that M grown by this much intersects count as the surface's; vertex_error is added.
  double padding = 0.0;
};

// The spheres, and how many voxels there are.
struct Voxelisation {
  std::vector<Sphere> spheres;  // one a voxel, along the Morton curve
  double step = 0.0;            // edge of the voxels
  std::size_t surface = 0;      // voxels that the surface may intersect
  std::size_t inside = 0;       // the others
};

// Conservative with circumscribed spheres (with Filling::kSurface: of the surface M only); with
// inscribed ones not. A grid of cubes, so placed that the mesh stands in its middle, with a sphere
// for every cube that M intersects (supercover; by separating axes with outward rounding, so that a
// cube that M misses by less than the rounding may count, too) and for every cube inside: what
// cannot be reached from outside of the grid from cube to cube through faces, without a cube that M
// intersects. So pockets whose way in is hardly wider than a cube are filled. The paper, sections
// III ("If part of the original mesh lies within a grid section, a voxel is placed into that grid
// position otherwise it is left empty") and IV.B ("voxelised using a 5 mm grid of 5 mm diameter
// spheres"). Throws Error for a mesh that validate() refuses, for options out of range, and for a
// step that makes too many cells or spheres (2^24), with the numbers.
Voxelisation voxelise(const TriangleMesh& mesh, const VoxelisationOptions& options);

// Sphere trees by halving cubes: conservative.

// How far cubes are halved.
struct OctreeSpheresOptions {
  // Halvings of the cube around the mesh; or 0, and max_error says how far to go.
  int depth = 0;
  // E: cubes are halved until their sphere is known to protrude from |M| by at most E, in the unit
  // of the mesh. In pockets that are filled, see below, it may be more.
  double max_error = 0.0;
  Filling filling = Filling::kSolid;
  // t: cubes that M grown by this much intersects count as the surface's; vertex_error is added.
  double padding = 0.0;
};

// The spheres, as a tree.
struct OctreeSpheres {
  // spheres() of this tree are the spheres around the cubes without halves; the inner nodes are the
  // spheres around the others, and nothing else.
  SphereTree tree;
  double step = 0.0;  // edge of the smallest cubes
};

// Conservative (with Filling::kSurface: of the surface M only). The sphere tree of Liu, Noborio and
// Arimoto (1988) and of Palmer and Grimsdale, "Collision Detection for Animation using
// Sphere-Trees" (1995): an octree over the mesh, with the sphere around every cube that is not
// empty. A cube that M intersects (as in voxelise()) is halved down to the given depth; a cube
// inside as long as its sphere may protrude by more than those of the smallest cubes. With
// max_error instead of a depth a cube that M intersects is halved only while the bound on its
// sphere's protrusion, radius plus (minus, if the centre is inside) the distance of the centre to
// M, is above E.
//
// The tree serves the same traversal as any other. The sphere around a cube contains those around
// its halves, touching them at the corners, so that no other parents are needed than the method's
// own; radii are larger by a share of 1e-12 or so, that they do so in rounded numbers, too.
//
// Pockets of the outside whose way in is hardly wider than the smallest cubes are filled.
// Throws Error for a mesh that validate() refuses, for options out of range (a depth of at most
// 20), and for a depth or error that makes more than 2^24 cells, with the numbers.
OctreeSpheres octree_spheres(const TriangleMesh& mesh, const OctreeSpheresOptions& options);

// Spheres in levels as the literature makes them, the coarsest first. Each level is meant to cover
// the solid by itself; a sphere need not enclose its children, only what they cover.
struct SphereLevels {
  std::vector<std::vector<Sphere>> levels;
  // parents[k][i]: the sphere of level k that sphere i of level k + 1 hangs under. One fewer than
  // levels.
  std::vector<std::vector<std::int32_t>> parents;
};

// Conservative if `leaves` are. A tree for the traversals of the library: its leaves are `leaves`,
// the finest level in its order, as it is or made conservative; the spheres above become as large
// as they have to be to enclose their children in exact arithmetic, about their own centre or,
// where that is smaller, about the centre of the sphere that encloses the children. A sphere
// without children is left out. Throws Error if the numbers of spheres and parents do not agree, or
// a parent is not there.
LevelTree enclosing_tree(const SphereLevels& levels, std::span<const Sphere> leaves);

// Sphere packing by OpenVDB: not conservative.

// How finely and how far the solid is filled.
struct LevelSetPackingOptions {
  // Edge of a voxel of the level set, in the unit of the mesh. Positive.
  double step = 0.0;
  // No sphere is smaller; 0 chooses half a step, below which the level set tells nothing.
  double min_radius = 0.0;
  std::size_t max_spheres = 10000;
  // Points of the inside that are examined as centres.
  std::size_t candidates = 20000;
  int threads = 0;  // 0: all
};

// Not conservative; made_conservative() grows the spheres until they cover. Sphere packing as
// OpenVDB's fillWithSpheres has it, beside the paper's own: the mesh becomes a level set (signed
// distances in voxels near the surface, in 32-bit floats), and the largest sphere that fits inside
// of it about one of many random points is taken, overlapping allowed, until no candidate is left
// outside of the spheres with a sphere of the least radius about it. The spheres lie in the solid
// up to a step. What is inside of an open mesh OpenVDB guesses; there may be no sphere then.
// Equal input gives equal results. Throws Error for a mesh that validate() refuses, for options out
// of range, and for a step below 1/4096 of the box diagonal.
std::vector<Sphere> level_set_packing(const TriangleMesh& mesh,
                                      const LevelSetPackingOptions& options);

// Spheres by adaptive medial axis approximation: not conservative.

// How many medial spheres become few (medial_spheres.h says how each works).
enum class SphereReduction {
  kMerge,   // two neighbours become one
  kBurst,   // one goes, its neighbours grow
  kExpand,  // all grow by the same, few are chosen
  kBest     // each of the three, and the best result is kept (default)
};

// How the surface is sampled.
struct MedialSampling {
  // Points of the surface that have to be covered: spread evenly, at least some on every triangle,
  // and, beside them, all corners and points of the edges as densely.
  std::size_t cover_points = 10000;
  std::size_t cover_points_per_triangle = 2;
  // Sites of the Voronoi diagram: at first, and at most after refinement.
  std::size_t initial_sites = 1000;
  std::size_t max_sites = 6000;
  // The medial spheres are refined towards a protrusion of the wanted one divided by this. Above 0,
  // at most 1e6.
  double error_factor = 2.0;
  std::uint64_t seed = 1;
};

// What is wanted: a number of spheres, or a protrusion.
struct MedialAxisOptions {
  // Wanted number of spheres; not examined if there is a wanted protrusion.
  std::size_t spheres = 512;
  // Wanted protrusion from the solid, in the unit of the mesh; 0: the count is what is wanted.
  double max_protrusion = 0.0;
  SphereReduction reduction = SphereReduction::kBest;
  MedialSampling sampling = {};
  int threads = 0;  // 0: all
};

// The spheres, and what they were chosen from.
struct MedialAxisSpheres {
  std::vector<Sphere> spheres;
  // Upper bound, up to rounding, of the largest distance from a point of the spheres to the solid:
  // the centres' clearances are measured. For open meshes inside is what MeshProbe takes for it.
  double protrusion = 0.0;
  std::size_t medial_spheres = 0;  // that they were made from
  std::size_t sites = 0;           // of the Voronoi diagram
  std::size_t cover_points = 0;    // all of them are in the spheres, in exact arithmetic
};

// Not conservative: the spheres hold all points that were sampled on the surface, and nothing is
// promised between them, nor of the inside of the solid; made_conservative() grows them until they
// cover. Adaptive medial-axis approximation (AMAA) after Bradshaw and O'Sullivan, "Adaptive
// medial-axis approximation for sphere-tree construction" (ACM Transactions on Graphics 23, 2004):
// spheres about the vertices of the Voronoi diagram of points on the surface that lie in the solid;
// more points where they protrude most; few spheres made of them by merging, bursting and
// expanding. With a wanted count there are at most so many spheres (fewer if the points need
// fewer); with a wanted protrusion they protrude by at most that, or by what the finest medial
// spheres do where `max_sites` did not suffice, and they are as few as the reductions find. Where
// they depart from the paper is said at each (medial_spheres.h). Where there is no inside (sheets),
// spheres about points of the surface are merged. Deterministic for equal input on any number of
// threads. Throws Error for a mesh that validate() refuses or that has no area, and for options out
// of range.
MedialAxisSpheres medial_axis(const TriangleMesh& mesh, const MedialAxisOptions& options = {});

// The shape of the tree.
struct MedialTreeOptions {
  int branching = 8;  // 2 to 64
  int depth = 3;      // levels below the root: at most branching^depth leaves. 1 to 8
  SphereReduction reduction = SphereReduction::kBest;
  MedialSampling sampling = {};
  int threads = 0;  // 0: all
};

// Not conservative: every level holds all points that were sampled on the surface, see
// medial_axis(); a sphere need not enclose its children (enclosing_tree() makes a tree of them that
// does). Level 0 is one sphere; the points of a sphere are covered anew by at most `branching`
// spheres of the next level, made of the medial spheres nearby, which are refined before each level
// until they protrude by less than that level by error_factor. Departure from the paper: they are
// refined over the whole solid at once, not sphere by sphere. Errors as there.
SphereLevels medial_axis_tree(const TriangleMesh& mesh, const MedialTreeOptions& options = {});

// Sphere packing of the solid as it is, as the paper compares with: not conservative.

// How densely the solid is packed.
struct SpherePackingOptions {
  // E: spheres are added until no point of the solid is further than this from them, in the unit of
  // the mesh. Positive.
  double max_error = 0.0;
  // Diameter at which a sphere is seeded (the paper's min_internal_size); 0 chooses E / 2.
  double seed_diameter = 0.0;
  // Ways into the solid that are narrower than this (or a little wider, by solid.closing_slack) are
  // taken for closed; 0 chooses E / 2.
  double closed_below = 0.0;
  double padding = 0.0;  // t: of the mesh; its vertex_error is added
  bool history = false;  // record the history (costs some time)
  std::uint64_t seed = 1;
  int threads = 0;  // 0: all
  Progress progress = {};
};

// The packing, and what is proved of it.
struct SpherePacking {
  std::vector<Sphere> spheres;   // inside of `solid`
  std::vector<Sphere> inflated;  // every radius larger by `error`: these contain `solid`
  double error = 0.0;            // proved, at most E
  std::vector<CoverHistoryEntry> history;
  ExternalSpheres solid;           // what was packed
  std::size_t seeds_rejected = 0;  // seeds that had to be moved before a sphere fitted
};

// Not conservative; `inflated` is. The generic sphere packing of the paper's comparisons: greedy,
// overlapping allowed, inside the solid as it is ("placing several spheres inside the bounds of a
// CAD model", section III; "static sphere packing that allows overlapping"). A sphere is grown at
// the point of the solid that is furthest from the spheres so far, until none is further than E;
// that is the second loop of Algorithm 1 (cover() with CoverMethod::kPaper), which the paper uses
// for both. The difference is what is filled. The bounding sphere simplification fills S, of which
// ways in narrower than min_ext_size are closed; the packing fills the mesh's own inside, S for a
// size next to nothing (`closed_below`). Without any external sphere S would be the box of the
// mesh, which is no packing of it.
//
// `solid` contains |M|, and is larger by a skin: in concave corners as thick as the first such
// spheres leave it, less than `closed_below`; elsewhere much thinner. A sphere may leave |M| by as
// much. History as of cover(). Deterministic on any number of threads. Throws Error as
// place_external_spheres() and cover() do.
SpherePacking pack_spheres(const TriangleMesh& mesh, const SpherePackingOptions& options);

// A stage 2 by adaptive medial axis approximation: conservative.

// Conservative: on return the union of the spheres contains S. A stage 2 method for simplify()
// (Stage2Method) in the place of cover(): the adaptive medial-axis approximation (AMAA, Bradshaw
// and O'Sullivan 2004; see medial_axis()) of the simplified solid S, whose clearances are exact,
// instead of the mesh. Medial spheres of points on the boundary of S are merged, burst or expanded
// to few that hold samples of S; what these leave open in between, a proof over cells of S finds,
// and it becomes samples, too. Then every radius grows by the certified depth that is still
// uncovered. How far the spheres may protrude before that is steered: of some trials that protrude
// from S by at most E in the end, as proved, the one with the fewest spheres is returned; if there
// is none, the one that protrudes least, and certify() says by how much.
//
// Uses max_error, min_radius (no sphere is smaller; that may protrude further), threads and
// progress of the options. The spheres before they grew, and by how much, are in the result as with
// CoverMethod::kPaper. Deterministic on any number of threads. Throws Error as cover() does, with
// the subject "zones" where E is smaller in a zone: only one max error is known here.
SphereCover medial_cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                         const CoverOptions& options);

// Spheres in levels by merging medial spheres, after Hubbard: not conservative.

// How many spheres there are to be, and of how many samples.
struct HubbardOptions {
  // Spheres of each level, the coarsest first, ascending, the first at least 1.
  std::vector<std::size_t> counts = {1, 8, 64, 512};
  // Sites of the Voronoi diagram, and points of the surface that have to be covered, spread evenly;
  // corners and points of the edges are covered too.
  std::size_t sites = 1000;
  std::size_t cover_points = 10000;
  std::uint64_t seed = 1;
  int threads = 0;  // 0: all
};

// Not conservative: every level holds all points that were sampled on the surface, and nothing is
// promised between them, nor of the inside of the solid; made_conservative() grows a level until it
// covers. After Hubbard, "Approximating polyhedra with spheres for time-critical collision
// detection" (ACM Transactions on Graphics 15, 1996): the medial axis as spheres about the Voronoi
// vertices of evenly spread points, not refined; then pairs of neighbours are merged from the
// bottom up, and each level is what is left when its count is reached, so that a sphere hangs under
// the one that it became part of. Departures: what a sphere has to hold is the points that it is
// responsible for (Hubbard: parts of the surface, about the points that formed it), and the pair
// that protrudes least is merged first (medial_spheres.h). A level has fewer spheres
// than wanted if there are no more. Deterministic for equal input on any number of threads. Throws
// Error for a mesh that validate() refuses or that has no area, and for options out of range.
SphereLevels hubbard_spheres(const TriangleMesh& mesh, const HubbardOptions& options = {});

}  // namespace spherule
