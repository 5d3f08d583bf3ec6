// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cad/internal/cad_shape.h"

#include "simplifier/cad/internal/cad_entities.h"
#include "simplifier/cad/internal/occt_geometry.h"
#include "simplifier/internal/raw_mesh.h"
#include "spheretree/error.h"

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Surface.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_TShape.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <gp_Trsf.hxx>
#include <limits>
#include <mutex>
#include <set>
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

// Keeps OpenCASCADE from printing.
class Silence {
 public:
  Silence() : printers_(Message::DefaultMessenger()->Printers()) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
  }
  ~Silence() { Message::DefaultMessenger()->ChangePrinters() = printers_; }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  Message_SequenceOfPrinters printers_;
};

// Its readers share settings and messages, and are used one at a time.
std::mutex& readers() {
  static std::mutex mutex;
  return mutex;
}

// Refuses a shape that lacks a face of something that is needed, or holds a scaled part.
void check_shape(const TopoDS_Shape& shape, XSControl_Reader& reader, const std::string& subject) {
  std::set<const TopoDS_TShape*> faces;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
    faces.insert(face.Current().TShape().get());
    constexpr double kRounding = 1e-12;
    const gp_Trsf placed = face.Current().Location().Transformation();
    if (!(std::abs(placed.ScaleFactor() - 1.0) <= kRounding)) {
      throw Error(subject, "holds a part that is scaled or mirrored in place, which is not read");
    }
  }
  const Handle(Interface_InterfaceModel) model = reader.Model();
  const Handle(Transfer_TransientProcess) process =
      reader.WS()->TransferReader()->TransientProcess();
  for (const Handle(Standard_Transient) & entity : needed_entities(model)) {
    const TopoDS_Shape result = TransferBRep::ShapeResult(process, entity);
    bool is_there = !result.IsNull();
    for (TopExp_Explorer face(result, TopAbs_FACE); face.More(); face.Next()) {
      is_there = is_there && faces.contains(face.Current().TShape().get());
    }
    if (!is_there) {
      throw Error(subject, "entity " + entity_name(model, entity) + " could not be translated");
    }
  }
}

TopoDS_Shape translated(XSControl_Reader& reader, const std::filesystem::path& path,
                        const std::string& kind) {
  const std::string subject = path.string();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) {
    throw Error(subject, "is not a " + kind + " file that can be read");
  }
  check_entities(reader.Model(), subject);
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  check_shape(shape, reader, subject);
  return shape;
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// The units of length that the file names, as a rule one.
std::string unit_of(STEPControl_Reader& reader) {
  TColStd_SequenceOfAsciiString lengths;
  TColStd_SequenceOfAsciiString angles;
  TColStd_SequenceOfAsciiString solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  std::set<std::string> names;
  for (int i = 1; i <= lengths.Length(); ++i) names.insert(lower_case(lengths(i).ToCString()));
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
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
  const std::lock_guard lock(readers());
  const Silence silence;
  try {
    const std::string extension = lower_extension(path);
    if (extension == "step" || extension == "stp") {
      check_step_text(bytes, subject_);
      STEPControl_Reader reader;
      shape_->shape = translated(reader, path, "STEP");
      stated_unit_ = unit_of(reader);
    } else {
      IGESControl_Reader reader;
      shape_->shape = translated(reader, path, "IGES");
      const Handle(TCollection_HAsciiString) unit =
          reader.IGESModel()->GlobalSection().UnitName();
      if (!unit.IsNull()) stated_unit_ = lower_case(unit->ToCString());
    }
  } catch (const Standard_Failure& failure) {
    throw Error(subject_, std::string("could not be read: ") + failure.GetMessageString());
  }
  if (shape_->shape.IsNull() || face_count() == 0) throw Error(subject_, "the file holds no faces");
}

CadShape::~CadShape() = default;

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
