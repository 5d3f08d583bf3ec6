// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Interface_InterfaceModel.hxx>
#include <Standard_Transient.hxx>
#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

// What a file's entities say before OpenCASCADE makes shapes of them. It leaves out silently what
// it has no shape for, so that only kinds which are known to be read, or to be no part of a shape,
// are let through. All throw Error with this subject, naming the entity.

// Refuses types that OpenCASCADE reads wrongly, by their names in the bytes of a STEP file.
void check_step_text(std::string_view bytes, const std::string& subject);

// Refuses entities that are broken, of an unknown type or of one that is not read: solids other
// than breps, tessellations, other files, scaled copies, items of a representation that are neither
// known to be read nor known to be no part of a shape.
void check_entities(const Handle(Interface_InterfaceModel) & model, const std::string& subject);

// The entities without whose shape a part would lack something: faces, surfaces that stand for
// themselves, and copies of parts.
std::vector<Handle(Standard_Transient)> needed_entities(const Handle(Interface_InterfaceModel) &
                                                        model);

// Its number in the file and its type.
std::string entity_name(const Handle(Interface_InterfaceModel) & model,
                        const Handle(Standard_Transient) & entity);

}  // namespace spherule::internal

// Reading a CAD file with OpenCASCADE. For sources that know its types.

namespace spherule::internal {

// A shape of an assembly that is no assembly itself, in its place.
struct CadLeaf {
  std::string name;
  TopoDS_Shape shape;
};

enum class Parts { kTogether, kApart };

// Shapes in millimetres.
struct Translation {
  TopoDS_Shape shape;           // all that the file holds
  std::string unit;             // as the file names it, in lower case
  std::vector<CadLeaf> leaves;  // with Parts::kApart: all faces of the shape, none twice
};

// `bytes` are those of the file. Throws Error as CadShape does.
Translation translate(const std::filesystem::path& path, std::string_view bytes, Parts parts);

}  // namespace spherule::internal

class STEPCAFControl_Reader;

namespace spherule::internal {

// Has the reader, which has read its file, translate all of it, and names the parts of the
// assembly: "GEARBOX/SHAFT", by their place in it where that has a name, else by the part. May
// throw what OpenCASCADE throws.
std::vector<CadLeaf> leaves_of_assembly(STEPCAFControl_Reader& reader);

// Parts of several solids as these, "PLATE/1", "PLATE/2", and what is no solid as another;
// parts without faces are left out. No name is there twice: others of it become "BOLT:2", "BOLT:3".
std::vector<CadLeaf> split_solids(const std::vector<CadLeaf>& leaves);

}  // namespace spherule::internal
