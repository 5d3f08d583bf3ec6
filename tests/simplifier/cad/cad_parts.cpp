// SPDX-License-Identifier: BSD-3-Clause
#include "tests/simplifier/cad/cad_parts.h"

#include "io/cad/cad_shape.h"
#include "tests/support/random.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Surface.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace spherule::test {
namespace {

Eigen::Vector3d vector(const gp_Pnt& p) {
  return {p.X(), p.Y(), p.Z()};
}

void hush() {
  Message::DefaultMessenger()->ChangePrinters().Clear();
}

}  // namespace

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

}  // namespace spherule::test
