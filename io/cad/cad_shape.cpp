// SPDX-License-Identifier: BSD-3-Clause
#include "io/cad/cad_shape.h"

#include "base/error.h"
#include "io/cad/cad_translation.h"
#include "io/cad/surface_deviation.h"

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomConvert_BSplineCurveToBezierCurve.hxx>
#include <GeomConvert_BSplineSurfaceToBezierSurface.hxx>
#include <GeomLib.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_ElementarySurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_Surface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
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

namespace spherule::internal {
namespace {

Eigen::Vector3d vector(const gp_XYZ& p) {
  return {p.X(), p.Y(), p.Z()};
}
Eigen::Vector3d vector(const gp_Pnt& p) {
  return vector(p.XYZ());
}
Eigen::Vector3d vector(const gp_Dir& d) {
  return vector(d.XYZ());
}

constexpr Interval kEndless{-std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::infinity()};

Eigen::Vector4d weighted(const gp_Pnt& p, double weight) {
  return {weight * p.X(), weight * p.Y(), weight * p.Z(), weight};
}

BezierNet net_of(const Handle(Geom_BezierCurve) & curve) {
  BezierNet net{curve->NbPoles(), 1, {}};
  for (int i = 1; i <= net.rows; ++i) {
    net.points.push_back(weighted(curve->Pole(i), curve->Weight(i)));
  }
  return net;
}

BezierNet net_of(const Handle(Geom_BezierSurface) & surface) {
  BezierNet net{surface->NbUPoles(), surface->NbVPoles(), {}};
  for (int i = 1; i <= net.rows; ++i) {
    for (int j = 1; j <= net.columns; ++j) {
      net.points.push_back(weighted(surface->Pole(i, j), surface->Weight(i, j)));
    }
  }
  return net;
}

std::vector<double> list_of(const TColStd_Array1OfReal& values) {
  return {values.begin(), values.end()};
}

CurveBound grid_bound(BezierGrid grid) {
  return [grid = std::move(grid)](Interval t) { return grid.curve_bounds(t); };
}

double largest_of(const gp_Pnt& p) {
  return vector(p).cwiseAbs().maxCoeff();
}

double largest_of(const TColgp_Array1OfPnt& poles) {
  double largest = 0.0;
  for (const gp_Pnt& pole : poles) largest = std::max(largest, largest_of(pole));
  return largest;
}

double largest_of(const TColgp_Array2OfPnt& poles) {
  double largest = 0.0;
  for (int i = poles.LowerRow(); i <= poles.UpperRow(); ++i) {
    for (int k = poles.LowerCol(); k <= poles.UpperCol(); ++k) {
      largest = std::max(largest, largest_of(poles.Value(i, k)));
    }
  }
  return largest;
}

// What is known of a curve. Without a bound for offset curves, parabolas and hyperbolas.
struct CurveFacts {
  CurveBound bound{};
  double largest = 0.0;  // of the coordinates and radii that it is evaluated from
  Interval domain = kEndless;
};

CurveFacts facts_of(const Handle(Geom_Curve) & any) {
  if (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(any); !trimmed.IsNull()) {
    return facts_of(trimmed->BasisCurve());
  }
  if (const auto line = Handle(Geom_Line)::DownCast(any); !line.IsNull()) {
    const gp_Pnt& point = line->Position().Location();
    return {line_bound(vector(point), vector(line->Position().Direction())), largest_of(point)};
  }
  const auto ellipse_facts = [](const gp_Pnt& center, double radius) -> CurveFacts {
    return {ellipse_bound(vector(center), radius), std::max(largest_of(center), radius)};
  };
  if (const auto circle = Handle(Geom_Circle)::DownCast(any); !circle.IsNull()) {
    return ellipse_facts(circle->Location(), circle->Radius());
  }
  if (const auto ellipse = Handle(Geom_Ellipse)::DownCast(any); !ellipse.IsNull()) {
    return ellipse_facts(ellipse->Location(), ellipse->MajorRadius());
  }
  if (const auto bezier = Handle(Geom_BezierCurve)::DownCast(any); !bezier.IsNull()) {
    return {grid_bound({{0.0, 1.0}, {0.0, 1.0}, {net_of(bezier)}, false, false}),
            largest_of(bezier->Poles()),
            {0.0, 1.0}};
  }
  const auto spline = Handle(Geom_BSplineCurve)::DownCast(any);
  if (spline.IsNull()) return {};
  GeomConvert_BSplineCurveToBezierCurve pieces(spline);
  TColStd_Array1OfReal knots(1, pieces.NbArcs() + 1);
  pieces.Knots(knots);
  std::vector<BezierNet> nets;
  for (int i = 1; i <= pieces.NbArcs(); ++i) nets.push_back(net_of(pieces.Arc(i)));
  const bool is_periodic = spline->IsPeriodic();
  const Interval domain{spline->FirstParameter(), spline->LastParameter()};
  return {grid_bound({list_of(knots), {0.0, 1.0}, nets, is_periodic, false}),
          largest_of(spline->Poles()), is_periodic ? kEndless : domain};
}

SurfaceBound grid_bound(const Handle(Geom_BSplineSurface) & surface) {
  GeomConvert_BSplineSurfaceToBezierSurface pieces(surface);
  TColStd_Array1OfReal u_knots(1, pieces.NbUPatches() + 1);
  TColStd_Array1OfReal v_knots(1, pieces.NbVPatches() + 1);
  pieces.UKnots(u_knots);
  pieces.VKnots(v_knots);
  std::vector<BezierNet> nets;
  for (int i = 1; i <= pieces.NbUPatches(); ++i) {
    for (int j = 1; j <= pieces.NbVPatches(); ++j) nets.push_back(net_of(pieces.Patch(i, j)));
  }
  return [grid = BezierGrid(list_of(u_knots), list_of(v_knots), nets, surface->IsUPeriodic(),
                            surface->IsVPeriodic())](Interval u, Interval v) {
    return grid.bounds(u, v);
  };
}

// What is known of a surface. Without a bound for offset surfaces, and for sweeps of curves that
// have none.
struct SurfaceFacts {
  std::function<SurfaceBound()> bound{};  // makes it, which may take long
  double largest = 0.0;                   // of the coordinates and radii that it is evaluated from
  Interval u = kEndless;
  Interval v = kEndless;
};

SurfaceFacts facts_of(const Handle(Geom_Surface) & any) {
  if (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(any);
      !trimmed.IsNull()) {
    return facts_of(trimmed->BasisSurface());
  }
  SurfaceFacts facts;
  if (const auto plain = Handle(Geom_ElementarySurface)::DownCast(any); !plain.IsNull()) {
    facts.largest = largest_of(plain->Location());
  }
  if (!Handle(Geom_Plane)::DownCast(any).IsNull()) {
    facts.bound = plane_bound;
  } else if (const auto cylinder = Handle(Geom_CylindricalSurface)::DownCast(any);
             !cylinder.IsNull()) {
    facts.bound = [=] { return cone_bound(cylinder->Radius(), 0.0); };
    facts.largest = std::max(facts.largest, cylinder->Radius());
  } else if (const auto cone = Handle(Geom_ConicalSurface)::DownCast(any); !cone.IsNull()) {
    facts.bound = [=] { return cone_bound(cone->RefRadius(), cone->SemiAngle()); };
    facts.largest = std::max({facts.largest, cone->RefRadius(), largest_of(cone->Apex())});
  } else if (const auto sphere = Handle(Geom_SphericalSurface)::DownCast(any); !sphere.IsNull()) {
    facts.bound = [=] { return torus_bound(0.0, sphere->Radius()); };
    facts.largest = std::max(facts.largest, sphere->Radius());
  } else if (const auto torus = Handle(Geom_ToroidalSurface)::DownCast(any); !torus.IsNull()) {
    facts.bound = [=] { return torus_bound(torus->MajorRadius(), torus->MinorRadius()); };
    facts.largest = std::max({facts.largest, torus->MajorRadius(), torus->MinorRadius()});
  } else if (const auto swept = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(any);
             !swept.IsNull()) {
    const CurveFacts curve = facts_of(swept->BasisCurve());
    if (curve.bound) facts.bound = [=] { return extrusion_bound(curve.bound); };
    facts.largest = curve.largest;
    facts.u = curve.domain;
  } else if (const auto turned = Handle(Geom_SurfaceOfRevolution)::DownCast(any);
             !turned.IsNull()) {
    const CurveFacts curve = facts_of(turned->BasisCurve());
    const gp_Ax1 axis = turned->Axis();
    if (curve.bound) {
      facts.bound = [=] {
        return revolution_bound(curve.bound, vector(axis.Location()), vector(axis.Direction()));
      };
    }
    facts.largest = std::max(curve.largest, largest_of(turned->Location()));
    facts.v = curve.domain;
  } else if (const auto bezier = Handle(Geom_BezierSurface)::DownCast(any); !bezier.IsNull()) {
    facts.bound = [=]() -> SurfaceBound {
      return [grid = BezierGrid({0.0, 1.0}, {0.0, 1.0}, {net_of(bezier)}, false, false)](
                 Interval u, Interval v) { return grid.bounds(u, v); };
    };
    facts.largest = largest_of(bezier->Poles());
    facts.u = facts.v = {0.0, 1.0};
  } else if (const auto spline = Handle(Geom_BSplineSurface)::DownCast(any); !spline.IsNull()) {
    facts.bound = [=] { return grid_bound(spline); };
    facts.largest = largest_of(spline->Poles());
    Interval u;
    Interval v;
    spline->Bounds(u.low, u.high, v.low, v.high);
    if (!spline->IsUPeriodic()) facts.u = u;
    if (!spline->IsVPeriodic()) facts.v = v;
  }
  return facts;
}

// The largest number that the surface of a face is evaluated from, where the face is placed or
// before. It may be far larger than the face.
double largest_length(const TopoDS_Face& face) {
  TopLoc_Location location;
  const Handle(Geom_Surface) unplaced = BRep_Tool::Surface(face, location);
  const gp_XYZ moved = location.Transformation().TranslationPart();
  return std::max({facts_of(BRep_Tool::Surface(face)).largest, facts_of(unplaced).largest,
                   vector(moved).cwiseAbs().maxCoeff()});
}

ParameterCurve curve_of(const Handle(Geom2d_Curve) & curve) {
  return {[curve](double t) {
            const gp_Pnt2d p = curve->Value(t);
            return Parameters(p.X(), p.Y());
          },
          facts_of(GeomLib::To3d(gp_Ax2(gp::Origin(), gp::DZ(), gp::DX()), curve)).bound};
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

ParametricSurface surface_of(const TopoDS_Face& face) {
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  const SurfaceFacts facts = facts_of(surface);
  return {[surface](const Parameters& p) { return vector(surface->Value(p.x(), p.y())); },
          facts.bound ? facts.bound() : SurfaceBound(), facts.u, facts.v};
}

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

}  // namespace spherule::internal
