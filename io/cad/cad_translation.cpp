// SPDX-License-Identifier: BSD-3-Clause
#include "io/cad/cad_translation.h"

#include "base/error.h"
#include "base/files.h"

#include <BRep_Builder.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Check.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepData_UndefinedEntity.hxx>
#include <StepGeom_Surface.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_GeometricSet.hxx>
#include <StepShape_GeometricSetSelect.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_TShape.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <gp_Trsf.hxx>
#include <iterator>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <utility>

namespace spherule::internal {
namespace {

using Model = Handle(Interface_InterfaceModel);
using Entity = Handle(Standard_Transient);

// Its number in the file and its type.
std::string entity_name(const Model& model, const Entity& entity) {
  std::string type = entity->DynamicType()->Name();
  type.erase(0, type.find('_') + 1);
  if (const auto unknown = Handle(StepData_UndefinedEntity)::DownCast(entity); !unknown.IsNull()) {
    type = unknown->StepType();
  } else if (const auto iges = Handle(IGESData_IGESEntity)::DownCast(entity); !iges.IsNull()) {
    type = "type " + std::to_string(iges->TypeNumber());
  }
  return std::string(model->StringLabel(entity)->ToCString()) + " (" + type + ")";
}

// By the names of OpenCASCADE's classes, of which it would take as many headers.
bool is_kind_of(const Entity& entity, std::span<const char* const> types) {
  return std::ranges::any_of(types, [&](const char* type) { return entity->IsKind(type); });
}

template <typename Numbers>
bool is_one_of(int number, const Numbers& numbers) {
  return std::find(std::begin(numbers), std::end(numbers), number) != std::end(numbers);
}

// A STEP entity that makes the shape more than OpenCASCADE says it is.
bool is_refused(const Entity& entity) {
  constexpr const char* kRefused[] = {"StepData_UndefinedEntity",
                                      "StepBasic_Document",
                                      "StepBasic_ExternalIdentificationAssignment",
                                      "StepBasic_ProductDefinitionWithAssociatedDocuments",
                                      "StepGeom_CartesianTransformationOperator",
                                      "StepRepr_FunctionallyDefinedTransformation",
                                      "StepShape_Block",
                                      "StepShape_BooleanResult",
                                      "StepShape_HalfSpaceSolid",
                                      "StepShape_RightAngularWedge",
                                      "StepShape_RightCircularCone",
                                      "StepShape_RightCircularCylinder",
                                      "StepShape_Sphere",
                                      "StepShape_Torus",
                                      "StepVisual_TessellatedItem"};
  const bool is_other_solid =
      entity->IsKind("StepShape_SolidModel") && !entity->IsKind("StepShape_ManifoldSolidBrep");
  const bool is_other_face =
      entity->IsKind("StepShape_Face") && !entity->IsKind("StepShape_FaceSurface");
  return is_other_solid || is_other_face || is_kind_of(entity, kRefused);
}

// Whether an item of a representation is read, checked as an entity of its own, or no part of a
// shape (notes, styles, measures).
bool is_known_item(const Entity& item) {
  constexpr const char* kKnown[] = {
      "StepGeom_Curve",
      "StepGeom_Direction",
      "StepGeom_Placement",
      "StepGeom_Point",
      "StepGeom_Vector",
      "StepShape_EdgeBasedWireframeModel",
      "StepShape_FaceBasedSurfaceModel",
      "StepShape_GeometricSet",
      "StepShape_ManifoldSolidBrep",
      "StepShape_MeasureRepresentationItemAndQualifiedRepresentationItem",
      "StepShape_QualifiedRepresentationItem",
      "StepShape_ShellBasedSurfaceModel",
      "StepShape_TopologicalRepresentationItem"};
  const std::string_view type = item->DynamicType()->Name();
  return type.starts_with("StepRepr_") || type.starts_with("StepVisual_") ||
         is_kind_of(item, kKnown);
}

void check_step(const Model& model, const Entity& entity, const std::string& subject) {
  const auto refuse = [&](const Entity& what) {
    throw Error(subject, "holds " + entity_name(model, what) + ", which is not read");
  };
  if (is_refused(entity)) refuse(entity);
  if (const auto mapped = Handle(StepRepr_MappedItem)::DownCast(entity); !mapped.IsNull()) {
    const Entity target = mapped->MappingTarget();
    if (target.IsNull() || !target->IsKind("StepGeom_Placement")) refuse(entity);
  }
  const auto representation = Handle(StepRepr_Representation)::DownCast(entity);
  if (representation.IsNull() || entity->IsKind("StepRepr_DefinitionalRepresentation")) {
    return;
  }
  for (int i = 1; i <= representation->NbItems(); ++i) {
    const Entity item = representation->ItemsValue(i);
    if (item.IsNull()) refuse(entity);
    if (!is_known_item(item)) refuse(item);
  }
}

void check_iges(const Model& model, const Handle(IGESData_IGESEntity) & entity,
                const std::string& subject) {
  // Elements, solids in place, arrays of copies, and references to other files.
  constexpr int kRefused[] = {136, 412, 414, 416, 430};
  const int type = entity->TypeNumber();
  const bool is_solid = type >= 150 && type <= 184;
  if (is_solid || is_one_of(type, kRefused) || entity->IsKind("IGESData_UndefinedEntity")) {
    throw Error(subject, "holds " + entity_name(model, entity) + ", which is not read");
  }
}

bool is_needed_of_iges(const Handle(IGESData_IGESEntity) & entity, const Interface_Graph& graph) {
  constexpr int kFacesAndCopies[] = {143, 144, 408, 510};
  constexpr int kSurfaces[] = {108, 114, 118, 120, 122, 128, 140, 186, 190, 192, 194, 196, 198};
  constexpr int kUsers[] = {140, 143, 144, 510};
  if (is_one_of(entity->TypeNumber(), kFacesAndCopies)) return true;
  if (!is_one_of(entity->TypeNumber(), kSurfaces)) return false;
  for (Interface_EntityIterator user = graph.Sharings(entity); user.More(); user.Next()) {
    const auto by = Handle(IGESData_IGESEntity)::DownCast(user.Value());
    if (!by.IsNull() && is_one_of(by->TypeNumber(), kUsers)) return false;
  }
  return true;
}

// Refuses types that OpenCASCADE reads wrongly, by their names in the bytes of a STEP file.
void check_step_text(std::string_view bytes, const std::string& subject) {
  // Scaled copies are read unscaled, or end the program.
  constexpr std::string_view kScaled = "CARTESIAN_TRANSFORMATION_OPERATOR";
  const std::size_t at = bytes.find(kScaled);
  if (at == std::string_view::npos) return;
  const std::size_t number = std::min(bytes.rfind('#', at), at);
  const std::size_t end = std::min(bytes.find_first_not_of("0123456789", number + 1), at);
  throw Error(subject, "holds " + std::string(bytes.substr(number, end - number)) + " (" +
                           std::string(kScaled) + "), which is not read");
}

// Refuses entities that are broken, of an unknown type or of one that is not read: solids other
// than breps, tessellations, other files, scaled copies, items of a representation that are neither
// known to be read nor known to be no part of a shape. OpenCASCADE leaves out silently what it has
// no shape for.
void check_entities(const Model& model, const std::string& subject) {
  const auto check = [&](const Handle(Interface_Check) & found, const std::string& what) {
    if (!found->HasFailed()) return;
    throw Error(subject, what + " is broken: " + found->CFail(1, true));
  };
  check(model->GlobalCheck(true), "the file");
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Entity entity = model->Value(i);
    check(model->Check(i, true), "entity " + entity_name(model, entity));
    const auto iges = Handle(IGESData_IGESEntity)::DownCast(entity);
    if (iges.IsNull()) {
      check_step(model, entity, subject);
    } else {
      check_iges(model, iges, subject);
    }
  }
}

// The entities without whose shape a part would lack something: faces, surfaces that stand for
// themselves, and copies of parts.
std::vector<Entity> needed_entities(const Model& model) {
  const Interface_Graph graph(model);
  std::vector<Entity> needed;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Entity entity = model->Value(i);
    if (const auto iges = Handle(IGESData_IGESEntity)::DownCast(entity); !iges.IsNull()) {
      if (is_needed_of_iges(iges, graph)) needed.push_back(entity);
    } else if (const auto set = Handle(StepShape_GeometricSet)::DownCast(entity); !set.IsNull()) {
      for (int k = 1; k <= set->NbElements(); ++k) {
        if (const auto surface = set->ElementsValue(k).Surface(); !surface.IsNull()) {
          needed.push_back(surface);
        }
      }
    } else if (entity->IsKind("StepShape_FaceSurface") || entity->IsKind("StepRepr_MappedItem") ||
               entity->IsKind("StepRepr_NextAssemblyUsageOccurrence")) {
      needed.push_back(entity);
    }
  }
  return needed;
}

// Empty where there is none, and where it is one that programs make up: "=>[0:1:1:2]", "NAUO7".
std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) attribute;
  if (!label.FindAttribute(TDataStd_Name::GetID(), attribute)) return {};
  const TCollection_ExtendedString& text = attribute->Get();
  std::string name(static_cast<std::size_t>(text.LengthOfCString()), '\0');
  Standard_PCharacter bytes = name.data();
  text.ToUTF8CString(bytes);
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  const std::size_t prefix = name.starts_with("NAUO") ? 4 : 0;
  const bool is_number =
      std::all_of(name.begin() + static_cast<std::ptrdiff_t>(prefix), name.end(), is_digit);
  return name.starts_with("=>[") || is_number ? std::string() : name;
}

class Walk {
 public:
  // `label` is a part, an assembly or an instance of either; `at` its place, `path` the names
  // above.
  void visit(const TDF_Label& label, const TopLoc_Location& at, const std::string& path) {
    TDF_Label part = label;
    TopLoc_Location place = at;
    std::string name = name_of(label);
    if (XCAFDoc_ShapeTool::IsReference(label)) {
      XCAFDoc_ShapeTool::GetReferredShape(label, part);
      place = at * XCAFDoc_ShapeTool::GetLocation(label);
      if (name.empty()) name = name_of(part);
    }
    if (name.empty()) name = "body";
    const std::string full_name = path.empty() ? name : path + "/" + name;
    if (!XCAFDoc_ShapeTool::IsAssembly(part)) {
      leaves.push_back({full_name, XCAFDoc_ShapeTool::GetShape(part).Moved(place)});
      return;
    }
    TDF_LabelSequence inner;
    XCAFDoc_ShapeTool::GetComponents(part, inner);
    for (const TDF_Label& one : inner) visit(one, place, full_name);
  }

  std::vector<CadLeaf> leaves;
};

bool has_face(const TopoDS_Shape& shape) {
  return TopExp_Explorer(shape, TopAbs_FACE).More();
}

// The shells, and the faces of no shell, that are of no solid.
TopoDS_Compound without_solids(const TopoDS_Shape& shape) {
  TopoDS_Compound rest;
  const BRep_Builder builder;
  builder.MakeCompound(rest);
  for (TopExp_Explorer shell(shape, TopAbs_SHELL, TopAbs_SOLID); shell.More(); shell.Next()) {
    builder.Add(rest, shell.Current());
  }
  for (TopExp_Explorer face(shape, TopAbs_FACE, TopAbs_SHELL); face.More(); face.Next()) {
    builder.Add(rest, face.Current());
  }
  return rest;
}

std::vector<CadLeaf> solids_of(const CadLeaf& leaf) {
  std::vector<CadLeaf> solids;
  for (TopExp_Explorer solid(leaf.shape, TopAbs_SOLID); solid.More(); solid.Next()) {
    solids.push_back({leaf.name + "/" + std::to_string(solids.size() + 1), solid.Current()});
  }
  if (solids.size() < 2) return {leaf};
  const TopoDS_Compound rest = without_solids(leaf.shape);
  if (has_face(rest)) {
    solids.push_back({leaf.name + "/" + std::to_string(solids.size() + 1), rest});
  }
  return solids;
}

// Has the reader, which has read its file, translate all of it, and names the parts of the
// assembly: "GEARBOX/SHAFT", by their place in it where that has a name, else by the part. May
// throw what OpenCASCADE throws.
std::vector<CadLeaf> leaves_of_assembly(STEPCAFControl_Reader& reader) {
  reader.SetNameMode(true);
  reader.SetColorMode(false);
  reader.SetLayerMode(false);
  reader.SetPropsMode(false);
  const Handle(XCAFApp_Application) application = XCAFApp_Application::GetApplication();
  Handle(TDocStd_Document) document;
  application->NewDocument("BinXCAF", document);
  std::vector<CadLeaf> leaves;
  if (reader.Transfer(document)) {
    TDF_LabelSequence roots;
    XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetFreeShapes(roots);
    Walk walk;
    for (const TDF_Label& root : roots) {
      if (!XCAFDoc_ShapeTool::IsAssembly(root)) {
        walk.visit(root, {}, {});
        continue;
      }
      // The name of the whole says nothing.
      TDF_LabelSequence inner;
      XCAFDoc_ShapeTool::GetComponents(root, inner);
      for (const TDF_Label& one : inner) walk.visit(one, {}, {});
    }
    leaves = std::move(walk.leaves);
  }
  application->Close(document);
  return leaves;
}

// Parts of several solids as these, "PLATE/1", "PLATE/2", and what is no solid as another; parts
// without faces are left out. No name is there twice: others of it become "BOLT:2", "BOLT:3".
std::vector<CadLeaf> split_solids(const std::vector<CadLeaf>& leaves) {
  std::vector<CadLeaf> bodies;
  for (const CadLeaf& leaf : leaves) {
    for (CadLeaf& body : solids_of(leaf)) {
      if (has_face(body.shape)) bodies.push_back(std::move(body));
    }
  }
  std::set<std::string> taken;
  for (const CadLeaf& body : bodies) taken.insert(body.name);
  std::map<std::string, int> times;
  for (CadLeaf& body : bodies) {
    int number = ++times[body.name];
    if (number == 1) continue;
    std::string name;
    do {
      name = body.name + ":" + std::to_string(number++);
    } while (!taken.insert(name).second);
    times[body.name] = number - 1;
    body.name = name;
  }
  return bodies;
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

// Reads the file, and has `transfer` translate what is in it.
template <typename Transfer>
TopoDS_Shape translated(XSControl_Reader& reader, const std::filesystem::path& path,
                        const std::string& kind, const Transfer& transfer) {
  const std::string subject = path.string();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) {
    throw Error(subject, "is not a " + kind + " file that can be read");
  }
  check_entities(reader.Model(), subject);
  transfer();
  const TopoDS_Shape shape = reader.OneShape();
  check_shape(shape, reader, subject);
  return shape;
}

Translation translate_step(const std::filesystem::path& path, Parts parts) {
  Translation result;
  if (parts == Parts::kTogether) {
    STEPControl_Reader reader;
    result.shape = translated(reader, path, "STEP", [&] { reader.TransferRoots(); });
    result.unit = unit_of(reader);
    return result;
  }
  STEPCAFControl_Reader named;
  STEPControl_Reader& reader = named.ChangeReader();
  result.shape =
      translated(reader, path, "STEP", [&] { result.leaves = leaves_of_assembly(named); });
  result.unit = unit_of(reader);
  return result;
}

Translation translate_iges(const std::filesystem::path& path) {
  Translation result;
  IGESControl_Reader reader;
  result.shape = translated(reader, path, "IGES", [&] { reader.TransferRoots(); });
  const Handle(TCollection_HAsciiString) unit = reader.IGESModel()->GlobalSection().UnitName();
  if (!unit.IsNull()) result.unit = lower_case(unit->ToCString());
  // IGES files have no names of parts.
  result.leaves = {{"body", result.shape}};
  return result;
}

int faces_of(const TopoDS_Shape& shape) {
  int number = 0;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) ++number;
  return number;
}

}  // namespace

Translation translate(const std::filesystem::path& path, std::string_view bytes, Parts parts) {
  const std::lock_guard lock(readers());
  const Silence silence;
  const std::string subject = path.string();
  Translation result;
  try {
    const std::string extension = lower_extension(path);
    if (extension == "step" || extension == "stp") {
      check_step_text(bytes, subject);
      result = translate_step(path, parts);
    } else {
      result = translate_iges(path);
    }
    if (result.shape.IsNull() || faces_of(result.shape) == 0) {
      throw Error(subject, "the file holds no faces");
    }
    if (parts == Parts::kTogether) return result;
    result.leaves = split_solids(result.leaves);
    int faces = 0;
    for (const CadLeaf& leaf : result.leaves) faces += faces_of(leaf.shape);
    if (faces != faces_of(result.shape)) {
      throw Error(subject, "its bodies could not be told apart: they have " +
                               std::to_string(faces) + " faces, all together " +
                               std::to_string(faces_of(result.shape)));
    }
  } catch (const Standard_Failure& failure) {
    throw Error(subject, std::string("could not be read: ") + failure.GetMessageString());
  }
  return result;
}

}  // namespace spherule::internal
