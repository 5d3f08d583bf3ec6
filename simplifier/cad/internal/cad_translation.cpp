// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cad/internal/cad_translation.h"

#include "mesh/parsing/input_file.h"
#include "simplifier/cad/internal/cad_assembly.h"
#include "simplifier/cad/internal/cad_entities.h"
#include "spheretree/error.h"

#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_TShape.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <cctype>
#include <cmath>
#include <gp_Trsf.hxx>
#include <mutex>
#include <set>

namespace spherule::internal {
namespace {

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
