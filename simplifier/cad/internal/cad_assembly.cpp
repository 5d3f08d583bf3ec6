// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cad/internal/cad_assembly.h"

#include <BRep_Builder.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <set>

namespace spherule::internal {
namespace {

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

}  // namespace

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

}  // namespace spherule::internal
