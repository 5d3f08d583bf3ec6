// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cad/internal/occt_geometry.h"

#include "simplifier/cad/internal/bezier_grid.h"

#include <BRep_Tool.hxx>
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
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_SweptSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

constexpr Interval kEndless{-std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::infinity()};

Eigen::Vector3d vector(const gp_XYZ& p) {
  return {p.X(), p.Y(), p.Z()};
}
Eigen::Vector3d vector(const gp_Pnt& p) {
  return vector(p.XYZ());
}
Eigen::Vector3d vector(const gp_Dir& d) {
  return vector(d.XYZ());
}

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

// Empty for kinds without a bound; `domain` is where the curve is defined.
CurveBound bound_of(const Handle(Geom_Curve) & any, Interval& domain) {
  domain = kEndless;
  if (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(any); !trimmed.IsNull()) {
    return bound_of(trimmed->BasisCurve(), domain);
  }
  if (const auto line = Handle(Geom_Line)::DownCast(any); !line.IsNull()) {
    return line_bound(vector(line->Position().Location()), vector(line->Position().Direction()));
  }
  if (const auto circle = Handle(Geom_Circle)::DownCast(any); !circle.IsNull()) {
    return ellipse_bound(vector(circle->Location()), circle->Radius());
  }
  if (const auto ellipse = Handle(Geom_Ellipse)::DownCast(any); !ellipse.IsNull()) {
    return ellipse_bound(vector(ellipse->Location()), ellipse->MajorRadius());
  }
  if (const auto bezier = Handle(Geom_BezierCurve)::DownCast(any); !bezier.IsNull()) {
    domain = {0.0, 1.0};
    return grid_bound({{0.0, 1.0}, {0.0, 1.0}, {net_of(bezier)}, false, false});
  }
  const auto spline = Handle(Geom_BSplineCurve)::DownCast(any);
  if (spline.IsNull()) return {};
  if (!spline->IsPeriodic()) domain = {spline->FirstParameter(), spline->LastParameter()};
  GeomConvert_BSplineCurveToBezierCurve pieces(spline);
  TColStd_Array1OfReal knots(1, pieces.NbArcs() + 1);
  pieces.Knots(knots);
  std::vector<BezierNet> nets;
  for (int i = 1; i <= pieces.NbArcs(); ++i) nets.push_back(net_of(pieces.Arc(i)));
  return grid_bound({list_of(knots), {0.0, 1.0}, nets, spline->IsPeriodic(), false});
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

// Bound and domain; the bound stays empty for kinds without one.
void set_bound(const Handle(Geom_Surface) & any, ParametricSurface& surface) {
  if (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(any);
      !trimmed.IsNull()) {
    set_bound(trimmed->BasisSurface(), surface);
  } else if (!Handle(Geom_Plane)::DownCast(any).IsNull()) {
    surface.bound = plane_bound();
  } else if (const auto cylinder = Handle(Geom_CylindricalSurface)::DownCast(any);
             !cylinder.IsNull()) {
    surface.bound = cone_bound(cylinder->Radius(), 0.0);
  } else if (const auto cone = Handle(Geom_ConicalSurface)::DownCast(any); !cone.IsNull()) {
    surface.bound = cone_bound(cone->RefRadius(), cone->SemiAngle());
  } else if (const auto sphere = Handle(Geom_SphericalSurface)::DownCast(any); !sphere.IsNull()) {
    surface.bound = torus_bound(0.0, sphere->Radius());
  } else if (const auto torus = Handle(Geom_ToroidalSurface)::DownCast(any); !torus.IsNull()) {
    surface.bound = torus_bound(torus->MajorRadius(), torus->MinorRadius());
  } else if (const auto swept = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(any);
             !swept.IsNull()) {
    if (CurveBound curve = bound_of(swept->BasisCurve(), surface.u)) {
      surface.bound = extrusion_bound(std::move(curve));
    }
  } else if (const auto turned = Handle(Geom_SurfaceOfRevolution)::DownCast(any);
             !turned.IsNull()) {
    if (CurveBound curve = bound_of(turned->BasisCurve(), surface.v)) {
      surface.bound = revolution_bound(std::move(curve), vector(turned->Axis().Location()),
                                       vector(turned->Axis().Direction()));
    }
  } else if (const auto bezier = Handle(Geom_BezierSurface)::DownCast(any); !bezier.IsNull()) {
    surface.u = surface.v = {0.0, 1.0};
    surface.bound = [grid = BezierGrid({0.0, 1.0}, {0.0, 1.0}, {net_of(bezier)}, false, false)](
                        Interval u, Interval v) { return grid.bounds(u, v); };
  } else if (const auto spline = Handle(Geom_BSplineSurface)::DownCast(any); !spline.IsNull()) {
    Interval u;
    Interval v;
    spline->Bounds(u.low, u.high, v.low, v.high);
    if (!spline->IsUPeriodic()) surface.u = u;
    if (!spline->IsVPeriodic()) surface.v = v;
    surface.bound = grid_bound(spline);
  }
}

double largest_of(const gp_Pnt& p) {
  return vector(p).cwiseAbs().maxCoeff();
}

double largest_length(const Handle(Geom_Curve) & any) {
  if (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(any); !trimmed.IsNull()) {
    return largest_length(trimmed->BasisCurve());
  }
  if (const auto line = Handle(Geom_Line)::DownCast(any); !line.IsNull()) {
    return largest_of(line->Position().Location());
  }
  if (const auto circle = Handle(Geom_Circle)::DownCast(any); !circle.IsNull()) {
    return std::max(largest_of(circle->Location()), circle->Radius());
  }
  if (const auto ellipse = Handle(Geom_Ellipse)::DownCast(any); !ellipse.IsNull()) {
    return std::max(largest_of(ellipse->Location()), ellipse->MajorRadius());
  }
  double largest = 0.0;
  if (const auto bezier = Handle(Geom_BezierCurve)::DownCast(any); !bezier.IsNull()) {
    for (const gp_Pnt& p : bezier->Poles()) largest = std::max(largest, largest_of(p));
  } else if (const auto spline = Handle(Geom_BSplineCurve)::DownCast(any); !spline.IsNull()) {
    for (const gp_Pnt& p : spline->Poles()) largest = std::max(largest, largest_of(p));
  }
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

double largest_length(const Handle(Geom_Surface) & any) {
  if (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(any);
      !trimmed.IsNull()) {
    return largest_length(trimmed->BasisSurface());
  }
  if (const auto swept = Handle(Geom_SweptSurface)::DownCast(any); !swept.IsNull()) {
    const auto turned = Handle(Geom_SurfaceOfRevolution)::DownCast(any);
    return std::max(largest_length(swept->BasisCurve()),
                    turned.IsNull() ? 0.0 : largest_of(turned->Location()));
  }
  double largest = 0.0;
  if (const auto plain = Handle(Geom_ElementarySurface)::DownCast(any); !plain.IsNull()) {
    largest = largest_of(plain->Location());
  }
  if (const auto cylinder = Handle(Geom_CylindricalSurface)::DownCast(any); !cylinder.IsNull()) {
    largest = std::max(largest, cylinder->Radius());
  } else if (const auto cone = Handle(Geom_ConicalSurface)::DownCast(any); !cone.IsNull()) {
    largest = std::max({largest, cone->RefRadius(), largest_of(cone->Apex())});
  } else if (const auto sphere = Handle(Geom_SphericalSurface)::DownCast(any); !sphere.IsNull()) {
    largest = std::max(largest, sphere->Radius());
  } else if (const auto torus = Handle(Geom_ToroidalSurface)::DownCast(any); !torus.IsNull()) {
    largest = std::max({largest, torus->MajorRadius(), torus->MinorRadius()});
  } else if (const auto bezier = Handle(Geom_BezierSurface)::DownCast(any); !bezier.IsNull()) {
    largest = largest_of(bezier->Poles());
  } else if (const auto spline = Handle(Geom_BSplineSurface)::DownCast(any); !spline.IsNull()) {
    largest = largest_of(spline->Poles());
  }
  return largest;
}

}  // namespace

// Both where the face is placed and before: it is evaluated from either.
double largest_length(const TopoDS_Face& face) {
  TopLoc_Location location;
  const Handle(Geom_Surface) unplaced = BRep_Tool::Surface(face, location);
  const gp_XYZ moved = location.Transformation().TranslationPart();
  return std::max({largest_length(BRep_Tool::Surface(face)), largest_length(unplaced),
                   vector(moved).cwiseAbs().maxCoeff()});
}

ParametricSurface surface_of(const TopoDS_Face& face) {
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  ParametricSurface result{
      [surface](const Parameters& p) { return vector(surface->Value(p.x(), p.y())); },
      {},
      kEndless,
      kEndless};
  set_bound(surface, result);
  return result;
}

ParameterCurve curve_of(const Handle(Geom2d_Curve) & curve) {
  Interval everywhere;
  return {[curve](double t) {
            const gp_Pnt2d p = curve->Value(t);
            return Parameters(p.X(), p.Y());
          },
          bound_of(GeomLib::To3d(gp_Ax2(gp::Origin(), gp::DZ(), gp::DX()), curve), everywhere)};
}

}  // namespace spherule::internal
