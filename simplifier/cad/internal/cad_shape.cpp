// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cad/internal/cad_shape.h"

#include "simplifier/cad/internal/cad_translation.h"
#include "simplifier/cad/internal/occt_geometry.h"
#include "spheretree/error.h"

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Surface.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_TShape.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Trsf.hxx>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace spherule {
namespace internal {
namespace {

Eigen::Vector3d vector(const gp_Pnt& p) {
  return {p.X(), p.Y(), p.Z()};
}

std::string kind_of(const TopoDS_Face& face) {
  std::string name = BRep_Tool::Surface(face)->DynamicType()->Name();
  if (name.starts_with("Geom_")) name.erase(0, 5);
  return name;
}

// How far the nodes of a side are from the curve, at the first and last of them.
double mismatch(const Poly_Triangulation& mesh, const Handle(Poly_PolygonOnTriangulation) & side,
                const Handle(Geom2d_Curve) & curve) {
  if (side.IsNull()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const int i : {1, side->NbNodes()}) {
    sum += mesh.UVNode(side->Node(i)).Distance(curve->Value(side->Parameter(i)));
  }
  return sum;
}

// Whether the nodes of a side run along the whole of its curve, in order.
bool spans(const Poly_PolygonOnTriangulation& side, double first, double last) {
  const double slack = 1e-9 * (last - first);
  const int count = side.NbNodes();
  for (int i = 1; i < count; ++i) {
    if (!(side.Parameter(i) < side.Parameter(i + 1))) return false;
  }
  return count > 1 && std::abs(side.Parameter(1) - first) <= slack &&
         std::abs(side.Parameter(count) - last) <= slack;
}

// Adds the sides of the mesh along the edge. Returns what is wrong.
std::string add_edge(const TopoDS_Edge& edge, const TopoDS_Face& face,
                     const Handle(Poly_Triangulation) & mesh, TessellatedFace& result) {
  if (edge.Orientation() != TopAbs_FORWARD && edge.Orientation() != TopAbs_REVERSED) return {};
  double first = 0.0;
  double last = 0.0;
  const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
  if (curve.IsNull()) return "an edge of it has no curve in its parameters";
  // A seam has two sides, which come in either order.
  TopLoc_Location location;
  BRep_Tool::Triangulation(face, location);
  Handle(Poly_PolygonOnTriangulation) side =
      BRep_Tool::PolygonOnTriangulation(edge, mesh, location);
  const Handle(Poly_PolygonOnTriangulation) other =
      BRep_Tool::PolygonOnTriangulation(TopoDS::Edge(edge.Reversed()), mesh, location);
  if (side.IsNull() || !side->HasParameters()) return "an edge of it has no nodes";
  if (mismatch(*mesh, other, curve) < mismatch(*mesh, side, curve)) side = other;
  if (!spans(*side, first, last)) return "the nodes of an edge of it do not run along its curve";
  const bool backwards = edge.Orientation() == TopAbs_REVERSED;
  for (int i = 1; i < side->NbNodes(); ++i) {
    const int a = backwards ? i + 1 : i;
    const int b = backwards ? i : i + 1;
    result.boundary.push_back({side->Node(a) - 1, side->Node(b) - 1, result.curves.size(),
                               side->Parameter(a), side->Parameter(b)});
  }
  result.curves.push_back(curve_of(curve));
  return {};
}

CadFace face_of(const TopoDS_Face& oriented, std::string name, const std::string& subject) {
  const TopoDS_Face face = TopoDS::Face(oriented.Oriented(TopAbs_FORWARD));
  TopLoc_Location location;
  const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
  if (mesh.IsNull() || mesh->NbTriangles() == 0) {
    throw Error(subject, name + " could not be tessellated");
  }
  CadFace result;
  result.name = std::move(name);
  result.reversed = oriented.Orientation() == TopAbs_REVERSED;
  TessellatedFace& part = result.tessellation;
  part.surface = surface_of(face);
  result.largest = largest_length(face);
  if (!mesh->HasUVNodes()) throw Error(subject, result.name + " has no parameters");
  for (int i = 1; i <= mesh->NbNodes(); ++i) {
    const gp_Pnt2d uv = mesh->UVNode(i);
    part.parameters.emplace_back(uv.X(), uv.Y());
    part.nodes.push_back(vector(mesh->Node(i).Transformed(location.Transformation())));
  }
  for (int i = 1; i <= mesh->NbTriangles(); ++i) {
    int a = 0;
    int b = 0;
    int c = 0;
    mesh->Triangle(i).Get(a, b, c);
    part.triangles.push_back({a - 1, b - 1, c - 1});
  }
  for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next()) {
    std::string fault = add_edge(TopoDS::Edge(edge.Current()), face, mesh, part);
    if (result.fault.empty()) result.fault = std::move(fault);
  }
  return result;
}

std::size_t count(TopExp_Explorer found) {
  std::size_t number = 0;
  for (; found.More(); found.Next()) ++number;
  return number;
}

}  // namespace

struct CadShape::Shape {
  TopoDS_Shape shape;
};

CadShape::CadShape(const std::filesystem::path& path, std::string_view bytes)
    : shape_(std::make_unique<Shape>()), subject_(path.string()) {
  Translation translation = translate(path, bytes, Parts::kTogether);
  shape_->shape = translation.shape;
  stated_unit_ = std::move(translation.unit);
}

CadShape::CadShape(std::unique_ptr<Shape> shape, std::string subject, std::string stated_unit)
    : shape_(std::move(shape)),
      subject_(std::move(subject)),
      stated_unit_(std::move(stated_unit)) {}

CadShape::CadShape(CadShape&&) noexcept = default;
CadShape& CadShape::operator=(CadShape&&) noexcept = default;
CadShape::~CadShape() = default;

std::vector<CadShape::Placed> CadShape::bodies(const std::filesystem::path& path,
                                               std::string_view bytes) {
  const Translation translation = translate(path, bytes, Parts::kApart);
  std::vector<Placed> bodies;
  // The first body of each shape, by what its places share and which way it is turned.
  std::map<std::pair<const TopoDS_TShape*, TopAbs_Orientation>, std::size_t> first;
  std::vector<TopLoc_Location> locations;
  for (const CadLeaf& leaf : translation.leaves) {
    const auto [known, is_new] = first.try_emplace(
        std::pair(leaf.shape.TShape().get(), leaf.shape.Orientation()), bodies.size());
    locations.push_back(leaf.shape.Location());
    Placed placed{.name = leaf.name};
    if (is_new) {
      auto shape = std::make_unique<Shape>();
      shape->shape = leaf.shape;
      placed.shape = CadShape(std::move(shape), path.string() + ": " + leaf.name, translation.unit);
    } else {
      const gp_Trsf motion =
          (leaf.shape.Location() * locations[known->second].Inverted()).Transformation();
      placed.copy_of = known->second;
      for (int row = 1; row <= 3; ++row) {
        for (int column = 1; column <= 4; ++column) {
          placed.from_original(row - 1, column - 1) = motion.Value(row, column);
        }
      }
    }
    bodies.push_back(std::move(placed));
  }
  return bodies;
}

double CadShape::diagonal() const {
  Bnd_Box box;
  BRepBndLib::Add(shape_->shape, box, false);
  return std::sqrt(box.SquareExtent());
}

double CadShape::tolerance() const {
  double largest = 0.0;
  for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX}) {
    largest = std::max(largest, BRep_Tool::MaxTolerance(shape_->shape, kind));
  }
  return largest;
}

std::size_t CadShape::face_count() const {
  return count(TopExp_Explorer(shape_->shape, TopAbs_FACE));
}

std::size_t CadShape::free_edge_count() const {
  return count(TopExp_Explorer(shape_->shape, TopAbs_EDGE, TopAbs_FACE));
}

void CadShape::tessellate(double deflection, double angle,
                          const std::function<void(const CadFace&)>& take) {
  try {
    BRepTools::Clean(shape_->shape);
    const BRepMesh_IncrementalMesh mesh(shape_->shape, deflection, false, angle, false);
    std::size_t number = 0;
    for (TopExp_Explorer face(shape_->shape, TopAbs_FACE); face.More(); face.Next()) {
      const TopoDS_Face current = TopoDS::Face(face.Current());
      const std::string name = "face " + std::to_string(++number) + " (" + kind_of(current) + ")";
      take(face_of(current, name, subject_));
    }
  } catch (const Standard_Failure& failure) {
    throw Error(subject_, std::string("could not be tessellated: ") + failure.GetMessageString());
  }
}

}  // namespace internal
}  // namespace spherule
