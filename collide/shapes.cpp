// SPDX-License-Identifier: BSD-3-Clause
#include "collide/shapes.h"

#include "base/error.h"
#include "collide/meshes/mesh_inside.h"
#include "collide/meshes/spheres_inside.h"
#include "collide/search/box_gap.h"
#include "collide/search/nearest_first.h"
#include "collide/search/queries.h"
#include "collide/search/traversal.h"
#include "collide/solids/convex.h"
#include "collide/solids/solid_fields.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::Convex;
using internal::ConvexGap;
using internal::ConvexPair;
using internal::NodePair;

// A shape as the search sees it: leaves under a tree of spheres, all grown alike.
struct Body {
  explicit Body(const SphereTree& spheres) : tree(&spheres) {}
  explicit Body(const MeshTree& surface) : tree(&surface.tree()), mesh(&surface) {}
  explicit Body(const SolidMesh& inside)
      : tree(&inside.mesh().tree()),
        mesh(&inside.mesh()),
        solid(&inside),
        growth(inside.inflation()) {}
  explicit Body(const CoveredMesh& covered) : Body(covered.solid()) {}
  // The sphere holds all of the solid that the other body can come near to.
  Body(const RoundedSolid& rounded, double reach)
      : own_tree(build_tree(std::vector<Sphere>{{Vector3d::Zero(), reach}})),
        tree(&*own_tree),
        convex(internal::convex_of(rounded.core)),
        core(rounded.core),
        growth(rounded.rounding) {}
  Body(const Body&) = delete;

  Convex leaf(std::int32_t index) const {
    if (convex) return *convex;
    if (mesh != nullptr) return Convex::triangle(mesh->triangle(index));
    return Convex::sphere(tree->spheres()[static_cast<std::size_t>(index)]);
  }
  // What is below a node, or more.
  Convex item(std::size_t node) const {
    return tree->is_leaf(node) ? leaf(tree->sphere_index(node))
                               : Convex::sphere(tree->sphere(node));
  }
  bool has_inside() const { return solid != nullptr && solid->has_inside(); }

  std::optional<SphereTree> own_tree{};
  const SphereTree* tree;
  const MeshTree* mesh = nullptr;
  const SolidMesh* solid = nullptr;
  std::optional<Convex> convex{};
  Primitive core{};  // of `convex`
  double growth = 0.0;
};

// Two bodies in their places, and the test of two of their leaves.
class BodyPair {
 public:
  BodyPair(const Body& a, const Pose& world_from_a, const Body& b, const Pose& world_from_b,
           double clearance = 0.0)
      : a_(a),
        b_(b),
        world_from_a_(world_from_a),
        pose_(*a.tree, world_from_a, *b.tree, world_from_b),
        a_from_b_(pose_.a_from_b()),
        b_from_a_(pose_.b_from_a()),
        growth_(sum_up(a.growth, b.growth)),
        reach_(sum_up(clearance, growth_)),
        size_(pose_.node_size() + growth_) {
    if (b.convex) solid_ = b.convex->placed(a_from_b_);
    const Vector3d apart = a.tree->root().center - a_from_b_(b.tree->root().center);
    if (apart.squaredNorm() > 0.0) axis_ = apart;
  }

  const Body& a() const { return a_; }
  const Body& b() const { return b_; }
  const Pose& world_from_a() const { return world_from_a_; }
  const internal::RelativePose& pose() const { return pose_; }
  double growth() const { return growth_; }
  double reach() const { return reach_; }
  double gap_error() const { return 160.0 * kUnitRoundoff * size_ + kUnderflow; }
  double image_error() const { return 136.0 * kUnitRoundoff * pose_.scene_size() + kUnderflow; }

  // The leaf tests of search/queries.h and nearest_first.h, without the growths.
  bool touches(NodePair pair) const { return gap_of(pair, reach_, reach_).lower <= reach_; }
  double gap(NodePair pair) const { return gap_of(pair, reach_, kNone).lower; }
  bool may_touch(NodePair pair) const { return node_gap(pair) <= reach_; }
  // What no leaves below two nodes are nearer than; where nodes overlap, how far they have to be
  // moved to part, with the sign changed.
  double node_gap(NodePair pair) const {
    const bool are_leaves = a_.tree->is_leaf(pair.index(0)) && b_.tree->is_leaf(pair.index(1));
    if (b_.convex && !are_leaves) {
      return solid_gap(a_.tree->sphere(pair.index(0)), b_from_a_, b_.core);
    }
    if (a_.mesh == nullptr || b_.mesh == nullptr) return kNone;
    return internal::box_gap(a_.mesh->node_boxes().box(pair.index(0)),
                             b_.mesh->node_boxes().box(pair.index(1)), b_from_a_) -
           (internal::kBoxError * pose_.scene_size() + 0x1p-160);
  }
  // Negative ends of leaves that overlap by more than rounding.
  internal::GapInterval interval(NodePair pair) const {
    ConvexGap found = gap_of(pair, least_upper_, kNone);
    if (found.lower <= 0.0 && found.upper < least_upper_) {
      const SpherePair leaves{a_.tree->sphere_index(pair.index(0)),
                              b_.tree->sphere_index(pair.index(1))};
      const auto overlap = contact(leaves, found.upper);
      if (overlap) found.upper = std::min(found.upper, growth_ - overlap->depth);
    }
    least_upper_ = std::min(least_upper_, found.upper);
    return {found.lower, found.upper};
  }

  // Of two leaves that are not farther apart than that, if they may overlap by `least` or more.
  std::optional<internal::ConvexContact> contact(
      const SpherePair& leaves, double reach,
      double least = -std::numeric_limits<double>::infinity()) const {
    const Convex of_a = a_.leaf(leaves.a), of_b = b_.leaf(leaves.b).placed(a_from_b_);
    const ConvexPair pair(of_a, of_b, size_);
    const ConvexGap found = pair.gap(axis_, reach);
    if (found.lower > reach || growth_ - found.lower < least) return std::nullopt;
    internal::ConvexContact result = pair.contact(found, a_.growth, b_.growth);
    // Of a sphere the depth is known, up to twice the error of the gap.
    if (a_.mesh == nullptr && !a_.convex && b_.convex) {
      const Sphere& sphere = a_.tree->spheres()[static_cast<std::size_t>(leaves.a)];
      result.depth = std::max(
          result.depth, growth_ - (solid_gap(sphere, b_from_a_, b_.core) + 2.0 * gap_error()));
    }
    return result;
  }

  // Whether a component of one lies in the inside of the other, if no leaves touch: nothing where
  // it cannot be told.
  std::optional<bool> is_inside() const {
    const std::optional<bool> of_a = holds_a_component(a_, b_, a_from_b_);
    if (of_a.value_or(false)) return of_a;
    const std::optional<bool> of_b = holds_a_component(b_, a_, b_from_a_);
    return of_b.value_or(false) ? of_b : (of_a && of_b ? of_b : std::nullopt);
  }
  bool may_be_inside() const { return is_inside().value_or(true); }

 private:
  static constexpr double kNone = -std::numeric_limits<double>::infinity();

  ConvexGap gap_of(NodePair pair, double enough, double near) const {
    const Convex of_a = a_.item(pair.index(0));
    const Convex of_b = solid_ ? *solid_ : b_.item(pair.index(1)).placed(a_from_b_);
    const ConvexGap found = ConvexPair(of_a, of_b, size_).gap(axis_, enough, near);
    axis_ = found.axis;
    return found;
  }

  // SolidPose::gap() (collide/solids/solid_pose.h), rounded downward.
  double solid_gap(const Sphere& sphere, const internal::FrameChange& change,
                   const Primitive& solid) const {
    const Vector3d center = change(sphere.center);
    const double distance = std::visit(
        [&](const auto& shape) { return internal::field_of(shape).signed_distance(center); },
        solid);
    return distance - sphere.radius - gap_error();
  }

  std::optional<bool> holds_a_component(const Body& holder, const Body& other,
                                        const internal::FrameChange& change) const {
    bool is_certain = true;
    const auto holds = [&](const Vector3d& point) {
      const std::optional<bool> found =
          holder.solid->inside().find(*holder.mesh, change(point), image_error());
      is_certain = is_certain && found.has_value();
      return found.value_or(false);
    };
    if (!holder.has_inside()) return false;
    if (other.mesh == nullptr && !other.convex) {
      // A tree is the first of the two, and none of its spheres touches a triangle here.
      const internal::SpheresInside spheres(*other.tree, *holder.solid, pose_);
      const std::int32_t found = spheres.find();
      if (found < 0) return false;
      const Vector3d& center = other.tree->spheres()[static_cast<std::size_t>(found)].center;
      return spheres.certainly_contains(spheres.in_mesh(center)) ? std::optional(true)
                                                                 : std::nullopt;
    }
    if (other.mesh == nullptr) {
      if (holds(Vector3d::Zero())) return true;
    } else {
      for (const Vector3d& point : other.mesh->component_points()) {
        if (holds(point)) return true;
      }
    }
    return is_certain ? std::optional(false) : std::nullopt;
  }

  const Body& a_;
  const Body& b_;
  const Pose& world_from_a_;
  const internal::RelativePose pose_;
  const internal::FrameChange a_from_b_;
  const internal::FrameChange b_from_a_;
  const double growth_;
  const double reach_;
  const double size_;
  std::optional<Convex> solid_;
  mutable Vector3d axis_ = Vector3d::UnitX();  // that separated two leaves last
  mutable double least_upper_ = std::numeric_limits<double>::infinity();
};

// All pairs of leaves within the reach.
class CollectLeaves : public internal::CollectPairs<BodyPair> {
 public:
  CollectLeaves(const BodyPair& pair, const CollisionRequest& request, CollisionResult& result)
      : CollectPairs(pair, *pair.a().tree, *pair.b().tree, request, result), pair_(pair) {}

  double margin(NodePair) const { return pair_.reach(); }
  bool nearest_first() const { return false; }
  bool enters(NodePair nodes) const { return pair_.may_touch(nodes); }

 private:
  const BodyPair& pair_;
};

// The deepest of them; of equal ones the first by the indices.
class DeepestLeaves {
 public:
  static constexpr bool kNeedsGaps = false;

  explicit DeepestLeaves(const BodyPair& pair) : pair_(pair) {}

  bool afford(const internal::OpenedPair&, const auto&) const { return true; }
  double margin(NodePair) const { return pair_.reach(); }
  bool nearest_first() const { return false; }
  // No leaves below overlap deeper than the nodes.
  bool enters(NodePair nodes) const {
    return pair_.may_touch(nodes) &&
           !(deepest_ && pair_.growth() - pair_.node_gap(nodes) < deepest_->depth);
  }
  bool leaves(NodePair nodes) {
    const SpherePair leaves{pair_.a().tree->sphere_index(nodes.index(0)),
                            pair_.b().tree->sphere_index(nodes.index(1))};
    const std::optional<internal::ConvexContact> contact =
        pair_.contact(leaves, pair_.reach(),
                      deepest_ ? deepest_->depth : -std::numeric_limits<double>::infinity());
    if (!contact) return true;
    if (deepest_ && (contact->depth < deepest_->depth ||
                     (contact->depth == deepest_->depth && leaves > leaves_))) {
      return true;
    }
    deepest_ = contact;
    leaves_ = leaves;
    return true;
  }
  const std::optional<internal::ConvexContact>& deepest() const { return deepest_; }
  const SpherePair& leaves() const { return leaves_; }

 private:
  const BodyPair& pair_;
  std::optional<internal::ConvexContact> deepest_;
  SpherePair leaves_;
};

bool come_within(const BodyPair& pair) {
  const SphereTree &a = *pair.a().tree, &b = *pair.b().tree;
  return (pair.may_touch(NodePair(0, 0)) &&
          internal::any_pair_within(a, b, pair.pose(), pair, pair.reach())) ||
         pair.may_be_inside();
}

// Of the leaves, without the growths.
DistanceResult nearest_leaves(const BodyPair& pair, const DistanceRequest& request) {
  const SphereTree &a = *pair.a().tree, &b = *pair.b().tree;
  const internal::PairSpace space(a, b, pair.pose(), pair);
  return internal::NearestFirst(space, pair.pose().gap_error(), request)
      .run(NodePair(0, 0), pair.pose().gap(a.sphere(0), b.sphere(0)));
}

DistanceResult distance_of(const BodyPair& pair, const DistanceRequest& request) {
  DistanceRequest to_leaves = request;
  to_leaves.enough = add_up(request.enough, pair.growth());
  DistanceResult result = nearest_leaves(pair, to_leaves);
  if (pair.growth() > 0.0) {
    result.lower = std::max(0.0, sub_down(result.lower, pair.growth()));
    result.upper = std::max(0.0, sub_up(result.upper, pair.growth()));
  }
  if (!(result.lower > 0.0)) return result;
  const std::optional<bool> inside = pair.is_inside();
  if (inside.value_or(true)) result.lower = 0.0;
  if (inside.value_or(false)) {
    result.upper = 0.0;
    result.nearest = {-1, -1};
  }
  return result;
}

CollisionResult collide_of(const BodyPair& pair, const CollisionRequest& request) {
  CollisionResult result;
  CollectLeaves query(pair, request, result);
  result.complete = request.max_node_tests > 0 && !query.out_of_time() &&
                    internal::traverse(*pair.a().tree, *pair.b().tree, pair.pose(), query);
  internal::conclude(query, pair.pose(), result);
  if (result.verdict != Verdict::kFree) return result;
  if (pair.may_be_inside()) result.verdict = Verdict::kCollision;
  result.distance_lower_bound =
      result.verdict == Verdict::kFree ? distance_of(pair, DistanceRequest{}).lower : 0.0;
  return result;
}

// Of two bodies of which collides() says that they touch.
std::optional<Contact> contact_of(const BodyPair& pair) {
  DeepestLeaves query(pair);
  internal::traverse(*pair.a().tree, *pair.b().tree, pair.pose(), query);
  if (query.deepest())
    return internal::placed_contact(query.leaves(), *query.deepest(), pair.world_from_a());
  // One is inside the other, and has to be moved by the distance of the surfaces that are grown,
  // and by the growths, at least; or tests of the two nearest leaves differ by rounding.
  const DistanceResult nearest = nearest_leaves(pair, DistanceRequest{});
  const bool inside = pair.may_be_inside();
  // From the nearest points; an inside is left through them.
  internal::ConvexContact found =
      *pair.contact(nearest.nearest, std::numeric_limits<double>::infinity());
  if (inside) {
    found.normal = -found.normal;
    found.depth = add_down(nearest.lower, pair.growth());
  }
  Contact contact = internal::placed_contact(nearest.nearest, found, pair.world_from_a());
  if (inside) contact.kind = ContactKind::kInside;
  return contact;
}

const RoundedSolid* solid_of(const ShapeRef& shape) {
  return std::get_if<RoundedSolid>(&shape.get());
}
bool is_half_space(const ShapeRef& shape) {
  const RoundedSolid* const solid = solid_of(shape);
  return solid != nullptr && std::holds_alternative<HalfSpace>(solid->core);
}

double reach_of(const Primitive& solid) {
  return next_up(
      std::visit([](const auto& shape) { return internal::field_of(shape).reach(); }, solid));
}

double reach_of(const ShapeRef& shape) {
  const Sphere around = internal::extent_of(shape).around;
  return around.radius + around.center.norm();
}

Body body_of(const ShapeRef& shape, double reach_of_other, double apart) {
  return std::visit(
      [&](const auto& content) -> Body {
        if constexpr (std::is_pointer_v<std::decay_t<decltype(content)>>) {
          return Body(*content);
        } else {
          if (!(content.rounding >= 0.0 && content.rounding <= kMaxCoordinate)) {
            throw Error("solid", "its rounding is not a number from 0 to 1e15");
          }
          return Body(content, is_half_space(shape) ? 2.0 * (reach_of_other + apart)
                                                    : reach_of(content.core));
        }
      },
      shape.get());
}

bool flipped(bool answer) {
  return answer;
}
template <class Result>
Result flipped(Result result) {
  std::swap(result.nearest.a, result.nearest.b);
  return result;
}
CollisionResult flipped(CollisionResult result) {
  for (SpherePair& pair : result.pairs) std::swap(pair.a, pair.b);
  std::sort(result.pairs.begin(), result.pairs.end());
  return result;
}
std::optional<Contact> flipped(std::optional<Contact> contact) {
  if (!contact) return contact;
  std::swap(contact->leaves.a, contact->leaves.b);
  contact->normal = -contact->normal;
  std::swap(contact->nearest_points[0], contact->nearest_points[1]);
  if (contact->triangles) std::swap(contact->triangles->a, contact->triangles->b);
  return contact;
}

template <class X>
inline constexpr bool kIsTree = std::is_same_v<X, SphereTree>;
template <class X, class Y>
inline constexpr bool kAreCovered = std::is_same_v<X, CoveredMesh>&& std::is_same_v<Y, CoveredMesh>;

// What `direct` calls is there for two types, without a rounding.
template <class Answer, class Direct>
std::optional<Answer> direct_answer(const ShapeRef& a, const Pose& world_from_a, const ShapeRef& b,
                                    const Pose& world_from_b, const Direct& direct) {
  return std::visit(
      [&](const auto& x, const auto& y) -> std::optional<Answer> {
        using X = std::remove_const_t<std::remove_pointer_t<std::decay_t<decltype(x)>>>;
        using Y = std::remove_const_t<std::remove_pointer_t<std::decay_t<decltype(y)>>>;
        if constexpr (kAreCovered<X, Y>) {
          return direct(*x, world_from_a, *y, world_from_b);
        } else if constexpr (!kIsTree<X>) {
          return std::nullopt;
        } else if constexpr (std::is_same_v<Y, CoveredMesh>) {
          return direct(*x, world_from_a, y->solid(), world_from_b);
        } else if constexpr (std::is_same_v<Y, RoundedSolid>) {
          if (y.rounding != 0.0) return std::nullopt;
          return direct(*x, world_from_a, y.core, world_from_b);
        } else {
          return direct(*x, world_from_a, *y, world_from_b);
        }
      },
      a.get(), b.get());
}

// In the order of ShapeRef::Alternatives, half-spaces last: by the function for the two types, or
// by the search.
template <class Answer, class Direct, class Search>
Answer answer(const ShapeRef& a, const Pose& world_from_a, const ShapeRef& b,
              const Pose& world_from_b, double clearance, const Direct& direct,
              const Search& search) {
  const std::size_t of_a = a.get().index(), of_b = b.get().index();
  if (of_a > of_b || (of_a == of_b && is_half_space(a) && !is_half_space(b))) {
    return flipped(answer<Answer>(b, world_from_b, a, world_from_a, clearance, direct, search));
  }
  if (std::optional<Answer> found =
          direct_answer<Answer>(a, world_from_a, b, world_from_b, direct)) {
    return *std::move(found);
  }
  const double apart = (world_from_a.translation() - world_from_b.translation()).norm();
  const Body body_a = body_of(a, reach_of(b), apart);
  const Body body_b = body_of(b, reach_of(a), apart);
  return search(BodyPair(body_a, world_from_a, body_b, world_from_b, clearance));
}

}  // namespace

ShapeRef::ShapeRef(const Shape& shape)
    : shape_(std::visit(
          [](const auto& content) -> Alternatives {
            if constexpr (std::is_same_v<std::decay_t<decltype(content)>, RoundedSolid>) {
              return content;
            } else {
              return content.get();
            }
          },
          shape)) {}

bool collides(const ShapeRef& a, const Pose& world_from_a, const ShapeRef& b,
              const Pose& world_from_b) {
  return answer<bool>(
      a, world_from_a, b, world_from_b, 0.0,
      [](const auto& x, const Pose& at_x, const auto& y, const Pose& at_y) {
        return std::optional(collides(x, at_x, y, at_y));
      },
      come_within);
}

bool within(const ShapeRef& a, const Pose& world_from_a, const ShapeRef& b,
            const Pose& world_from_b, double clearance) {
  require_clearance(clearance);
  return answer<bool>(
      a, world_from_a, b, world_from_b, clearance,
      [&]<class X, class Y>(const X& x, const Pose& at_x, const Y& y,
                            const Pose& at_y) -> std::optional<bool> {
        if constexpr (kIsTree<X>) {
          return within(x, at_x, y, at_y, clearance);
        } else {
          return std::nullopt;
        }
      },
      come_within);
}

CollisionResult collide(const ShapeRef& a, const Pose& world_from_a, const ShapeRef& b,
                        const Pose& world_from_b, const CollisionRequest& request) {
  return answer<CollisionResult>(
      a, world_from_a, b, world_from_b, 0.0,
      [&]<class X, class Y>(const X& x, const Pose& at_x, const Y& y,
                            const Pose& at_y) -> std::optional<CollisionResult> {
        if constexpr (kIsTree<X> && !std::is_same_v<Y, SolidMesh>) {
          return collide(x, at_x, y, at_y, request);
        } else {
          return std::nullopt;
        }
      },
      [&](const BodyPair& pair) { return collide_of(pair, request); });
}

DistanceResult distance(const ShapeRef& a, const Pose& world_from_a, const ShapeRef& b,
                        const Pose& world_from_b, const DistanceRequest& request) {
  return answer<DistanceResult>(
      a, world_from_a, b, world_from_b, 0.0,
      [&]<class X, class Y>(const X& x, const Pose& at_x, const Y& y,
                            const Pose& at_y) -> std::optional<DistanceResult> {
        if constexpr (kIsTree<X>) {
          return distance(x, at_x, y, at_y, request);
        } else {
          return std::nullopt;
        }
      },
      [&](const BodyPair& pair) { return distance_of(pair, request); });
}

std::optional<Contact> deepest_contact(const ShapeRef& a, const Pose& world_from_a,
                                       const ShapeRef& b, const Pose& world_from_b) {
  return answer<std::optional<Contact>>(
      a, world_from_a, b, world_from_b, 0.0,
      [&]<class X, class Y>(const X& x, const Pose& at_x, const Y& y,
                            const Pose& at_y) -> std::optional<std::optional<Contact>> {
        if constexpr (kAreCovered<X, Y> || std::is_same_v<Y, SphereTree> ||
                      std::is_same_v<Y, SolidMesh>) {
          return deepest_contact(x, at_x, y, at_y);
        } else {
          return std::nullopt;
        }
      },
      [&](const BodyPair& pair) {
        return collides(a, world_from_a, b, world_from_b) ? contact_of(pair) : std::nullopt;
      });
}

namespace internal {

Extent extent_of(const ShapeRef& shape) {
  return std::visit(
      [](const auto& content) -> Extent {
        if constexpr (std::is_same_v<std::decay_t<decltype(content)>, RoundedSolid>) {
          return {{Vector3d::Zero(), sum_up(reach_of(content.core), content.rounding)},
                  !std::holds_alternative<HalfSpace>(content.core)};
        } else if constexpr (std::is_same_v<std::decay_t<decltype(*content)>, SphereTree>) {
          return {content->root(), true};
        } else {
          const Body body(*content);
          return {{body.tree->root().center, sum_up(body.tree->root().radius, body.growth)}, true};
        }
      },
      shape.get());
}

}  // namespace internal

}  // namespace spherule
