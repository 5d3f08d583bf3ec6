// SPDX-License-Identifier: BSD-3-Clause
#include "tests/simplifier/cad/cad_parts.h"

#include "io/cad/cad_shape.h"
#include "tests/support/random.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <GeomAPI_PointsToBSplineSurface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Surface.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Elips.hxx>
#include <gp_Trsf.hxx>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace spherule::test {
namespace {

constexpr double kTolerance = 1e-6;

gp_Ax2 tilted() {
  return {gp_Pnt(12, -7, 31), gp_Dir(0.4, 0.5, 0.8), gp_Dir(1, 0, -0.5)};
}

TopoDS_Shape sphere() {
  return BRepPrimAPI_MakeSphere(tilted(), 20).Shape();
}

TopoDS_Shape torus() {
  return BRepPrimAPI_MakeTorus(tilted(), 25, 8).Shape();
}

// A sheet over a square of 40, its heights random.
Handle(Geom_BSplineSurface) wavy_surface() {
  Random random(11);
  TColgp_Array2OfPnt points(1, 7, 1, 7);
  for (int i = 1; i <= 7; ++i) {
    for (int j = 1; j <= 7; ++j) {
      points.SetValue(i, j, gp_Pnt(40.0 / 6 * (i - 1), 40.0 / 6 * (j - 1), random.between(0, 6)));
    }
  }
  return GeomAPI_PointsToBSplineSurface(points, 3, 5, GeomAbs_C2, 1e-3).Surface();
}

// A rational patch with very different weights.
TopoDS_Shape rational_patch() {
  Random random(5);
  TColgp_Array2OfPnt poles(1, 4, 1, 3);
  TColStd_Array2OfReal weights(1, 4, 1, 3);
  for (int i = 1; i <= 4; ++i) {
    for (int j = 1; j <= 3; ++j) {
      poles.SetValue(i, j, gp_Pnt(10.0 * i, 12.0 * j, random.between(0, 8)));
      weights.SetValue(i, j, random.between(0.5, 2.0));
    }
  }
  const Handle(Geom_BezierSurface) surface = new Geom_BezierSurface(poles, weights);
  return BRepBuilderAPI_MakeFace(surface, kTolerance).Shape();
}

Handle(Geom_BSplineCurve) wavy_curve() {
  TColgp_Array1OfPnt points(1, 6);
  const double radii[] = {10, 13, 9, 14, 12, 8};
  for (int i = 0; i < 6; ++i) points.SetValue(i + 1, gp_Pnt(radii[i], 0, 8.0 * i));
  return GeomAPI_PointsToBSpline(points).Curve();
}

// A surface that is only continuous along a line: a roof of degree one, bent along the other way.
// The weights of one of its two pieces are equal, so that OpenCASCADE gives that one none.
TopoDS_Shape creased_face() {
  TColgp_Array2OfPnt poles(1, 3, 1, 3);
  TColStd_Array2OfReal weights(1, 3, 1, 3);
  const double heights[] = {0, 12, 2};
  for (int i = 1; i <= 3; ++i) {
    for (int j = 1; j <= 3; ++j) {
      poles.SetValue(i, j, gp_Pnt(15.0 * i, 15.0 * j, heights[i - 1] + (j == 2 ? 6.0 : 0.0)));
      weights.SetValue(i, j, i == 3 ? 0.7 : 1.0);
    }
  }
  TColStd_Array1OfReal u_knots(1, 3);
  TColStd_Array1OfInteger u_times(1, 3);
  TColStd_Array1OfReal v_knots(1, 2);
  TColStd_Array1OfInteger v_times(1, 2);
  for (int i = 1; i <= 3; ++i) {
    u_knots.SetValue(i, i == 2 ? 0.37 : 0.5 * (i - 1));
    u_times.SetValue(i, i == 2 ? 1 : 2);
  }
  for (int j = 1; j <= 2; ++j) {
    v_knots.SetValue(j, j - 1.0);
    v_times.SetValue(j, 3);
  }
  const Handle(Geom_BSplineSurface) surface =
      new Geom_BSplineSurface(poles, weights, u_knots, v_knots, u_times, v_times, 1, 2);
  return BRepBuilderAPI_MakeFace(surface, kTolerance).Shape();
}

// A plate with two holes, one of them slanted, and all of its outer edges rounded.
TopoDS_Shape plate() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(60, 40, 12).Shape();
  BRepFilletAPI_MakeFillet rounded(box);
  for (TopExp_Explorer edge(box, TopAbs_EDGE); edge.More(); edge.Next()) {
    rounded.Add(3.0, TopoDS::Edge(edge.Current()));
  }
  const TopoDS_Shape straight =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(18, 20, -5), gp_Dir(0, 0, 1)), 7, 30).Shape();
  const TopoDS_Shape slanted =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(38, 20, -5), gp_Dir(0.3, 0, 1)), 5, 30).Shape();
  return BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(rounded.Shape(), straight).Shape(), slanted).Shape();
}

TopoDS_Shape extruded_ellipse() {
  const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(gp_Elips(tilted(), 20, 8), 0.3, 4.0).Edge();
  return BRepPrimAPI_MakePrism(edge, gp_Vec(5, 0, 30)).Shape();
}

TopoDS_Shape extruded_spline() {
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeEdge(wavy_curve()).Edge(), gp_Vec(0, 25, 0))
      .Shape();
}

TopoDS_Shape revolved_spline() {
  return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeEdge(wavy_curve()).Edge(),
                               gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 5.0)
      .Shape();
}

Eigen::Vector3d vector(const gp_Pnt& p) {
  return {p.X(), p.Y(), p.Z()};
}

void hush() {
  Message::DefaultMessenger()->ChangePrinters().Clear();
}

}  // namespace

const std::vector<NamedShape>& provable_shapes() {
  static const std::vector<NamedShape> kShapes = {
      {"box", [] { return BRepPrimAPI_MakeBox(20, 30, 40).Shape(); }},
      {"cylinder", [] { return BRepPrimAPI_MakeCylinder(tilted(), 10, 50).Shape(); }},
      {"cone", [] { return BRepPrimAPI_MakeCone(tilted(), 15, 0, 30).Shape(); }},
      {"frustum", [] { return BRepPrimAPI_MakeCone(tilted(), 15, 5, 30).Shape(); }},
      {"sphere", sphere},
      {"torus", torus},
      {"plate", plate},
      {"rational_patch", rational_patch},
      {"spline_sphere", [] { return BRepBuilderAPI_NurbsConvert(sphere(), true).Shape(); }},
      {"drilled_sphere",
       [] {
         const TopoDS_Shape drill = BRepPrimAPI_MakeCylinder(tilted(), 6, 40).Shape();
         return BRepAlgoAPI_Cut(sphere(), drill).Shape();
       }},
      {"wavy_face", [] { return BRepBuilderAPI_MakeFace(wavy_surface(), kTolerance).Shape(); }},
      {"creased_face", creased_face},
      {"spline_torus", [] { return BRepBuilderAPI_NurbsConvert(torus(), true).Shape(); }},
      {"extruded_ellipse", extruded_ellipse},
      {"extruded_spline", extruded_spline},
      {"revolved_spline", revolved_spline}};
  return kShapes;
}

TopoDS_Shape shape_named(const std::string& name) {
  for (const NamedShape& candidate : provable_shapes()) {
    if (candidate.name == name) return candidate.make();
  }
  throw std::out_of_range(name);
}

TopoDS_Shape offset_face() {
  const Handle(Geom_OffsetSurface) surface = new Geom_OffsetSurface(wavy_surface(), 1.5);
  return BRepBuilderAPI_MakeFace(surface, kTolerance).Shape();
}

TopoDS_Shape wire() {
  BRepBuilderAPI_MakePolygon polygon(gp_Pnt(0, 0, 0), gp_Pnt(10, 0, 0), gp_Pnt(10, 10, 0),
                                     gp_Pnt(0, 10, 0), true);
  return polygon.Shape();
}

TopoDS_Shape assembly() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(20, 10, 5).Shape();
  gp_Trsf turned;
  turned.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 0.5 * std::numbers::pi);
  gp_Trsf placed;
  placed.SetTranslation(gp_Vec(100, 0, 0));
  TopoDS_Compound both;
  const BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, box);
  builder.Add(both, box.Moved(TopLoc_Location(placed * turned)));
  return both;
}

void write_step(const TopoDS_Shape& shape, const std::filesystem::path& path,
                const std::string& unit) {
  hush();
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("write.step.unit", unit.c_str());  // read when a writer is made
  Interface_Static::SetIVal("write.step.assembly", 2);         // where the shape is a compound
  STEPControl_Writer writer;
  const bool done = writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone &&
                    writer.Write(path.c_str()) == IFSelect_RetDone;
  if (!done) throw std::runtime_error("cannot write " + path.string());
}

void write_iges(const TopoDS_Shape& shape, const std::filesystem::path& path) {
  hush();
  IGESControl_Writer writer("MM", 1);
  if (!writer.AddShape(shape) || !writer.Write(path.c_str())) {
    throw std::runtime_error("cannot write " + path.string());
  }
}

std::vector<Eigen::Vector3d> points_of(const TopoDS_Shape& shape, int per_face,
                                       std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector3d> points;
  for (TopExp_Explorer found(shape, TopAbs_FACE); found.More(); found.Next()) {
    const TopoDS_Face face = TopoDS::Face(found.Current());
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
    BRepTopAdaptor_FClass2d inside(face, 1e-9);
    double u0 = 0.0;
    double u1 = 0.0;
    double v0 = 0.0;
    double v1 = 0.0;
    BRepTools::UVBounds(face, u0, u1, v0, v1);
    for (int k = 0; k < per_face; ++k) {
      const gp_Pnt2d uv(random.between(u0, u1), random.between(v0, v1));
      if (inside.Perform(uv) == TopAbs_IN) points.push_back(vector(surface->Value(uv.X(), uv.Y())));
    }
  }
  for (TopExp_Explorer found(shape, TopAbs_EDGE); found.More(); found.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(found.Current());
    if (BRep_Tool::Degenerated(edge)) continue;
    const BRepAdaptor_Curve curve(edge);
    for (int k = 0; k < per_face / 8; ++k) {
      points.push_back(
          vector(curve.Value(random.between(curve.FirstParameter(), curve.LastParameter()))));
    }
  }
  return points;
}

std::string broken_bounds(const TopoDS_Shape& shape, int rectangles, double& tightest) {
  Random random(3);
  std::ostringstream broken;
  tightest = 0.0;
  for (TopExp_Explorer found(shape, TopAbs_FACE); found.More(); found.Next()) {
    const TopoDS_Face face = TopoDS::Face(found.Current());
    const internal::ParametricSurface surface = internal::surface_of(face);
    const Handle(Geom_Surface) truth = BRep_Tool::Surface(face);
    std::array<double, 4> whole{};
    BRepTools::UVBounds(face, whole[0], whole[1], whole[2], whole[3]);
    for (int k = 0; k < rectangles; ++k) {
      const auto part = [&](double low, double high) {
        const double a = random.between(low, high);
        const double b = a + (high - a) * random.unit() * random.unit();
        return internal::Interval{a, b};
      };
      const internal::Interval u = part(whole[0], whole[1]);
      const internal::Interval v = part(whole[2], whole[3]);
      const internal::SurfaceBounds bounds = surface.bound(u, v);
      for (int sample = 0; sample < 20; ++sample) {
        gp_Pnt p;
        std::array<gp_Vec, 5> d;
        truth->D2(random.between(u.low, u.high), random.between(v.low, v.high), p, d[0], d[1], d[2],
                  d[3], d[4]);
        const std::array<double, 5> limits{bounds.u, bounds.v, bounds.uu, bounds.vv, bounds.uv};
        for (std::size_t i = 0; i < 5; ++i) {
          const double size = d[i].Magnitude();
          if (broken.str().empty() && size > limits[i] * (1.0 + 1e-9) + 1e-9) {
            broken << "derivative " << i << ": " << size << " > " << limits[i] << "\n";
          }
          if (i > 1 && limits[i] > 0.0) tightest = std::max(tightest, size / limits[i]);
        }
      }
    }
  }
  return broken.str();
}

void write_assembly(const std::vector<AssemblyPart>& parts, const std::filesystem::path& path,
                    bool name_instances) {
  const Handle(XCAFApp_Application) application = XCAFApp_Application::GetApplication();
  Handle(TDocStd_Document) document;
  application->NewDocument("BinXCAF", document);
  const Handle(XCAFDoc_ShapeTool) tool = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const TDF_Label root = tool->NewShape();
  TDataStd_Name::Set(root, "ROOT");
  const TDF_Label inner = tool->NewShape();
  TDataStd_Name::Set(inner, "CELL");
  tool->AddComponent(root, inner, TopLoc_Location());
  for (const AssemblyPart& part : parts) {
    const TDF_Label product = tool->AddShape(part.shape, false);
    TDataStd_Name::Set(product, part.name.c_str());
    int number = 0;
    for (const TopLoc_Location& place : part.places) {
      const TDF_Label instance = tool->AddComponent(inner, product, place);
      if (name_instances) {
        TDataStd_Name::Set(instance, (part.name + " no " + std::to_string(++number)).c_str());
      }
    }
  }
  tool->UpdateAssemblies();
  Interface_Static::SetCVal("write.step.unit", "MM");
  STEPCAFControl_Writer writer;
  const bool done = writer.Transfer(document) && writer.Write(path.c_str()) == IFSelect_RetDone;
  application->Close(document);
  if (!done) throw std::runtime_error("cannot write " + path.string());
}

std::vector<AssemblyPart> box_parts(int parts, int places) {
  std::vector<AssemblyPart> result;
  for (int i = 0; i < parts; ++i) {
    AssemblyPart part{.name = "PART_" + std::to_string(i),
                      .shape = BRepPrimAPI_MakeBox(20.0 + i, 10.0, 5.0 + 0.5 * i).Shape(),
                      .places = {}};
    for (int k = 0; k < places; ++k) {
      gp_Trsf turned;
      turned.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 2, 3)), 0.7 * k);
      gp_Trsf shifted;
      shifted.SetTranslation(gp_Vec(100.0 * k, 100.0 * i, 0));
      part.places.emplace_back(shifted * turned);
    }
    result.push_back(std::move(part));
  }
  return result;
}

}  // namespace spherule::test
