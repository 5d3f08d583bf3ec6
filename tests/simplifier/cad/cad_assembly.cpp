// SPDX-License-Identifier: BSD-3-Clause
#include "tests/simplifier/cad/cad_assembly.h"

#include <BRepPrimAPI_MakeBox.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Ax1.hxx>
#include <gp_Trsf.hxx>
#include <stdexcept>
#include <utility>

namespace spherule::test {

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
