// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Interface_InterfaceModel.hxx>
#include <Standard_Transient.hxx>
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
