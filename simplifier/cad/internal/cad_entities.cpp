// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cad/internal/cad_entities.h"

#include "spheretree/error.h"

#include <IGESData_IGESEntity.hxx>
#include <IGESData_UndefinedEntity.hxx>
#include <Interface_Check.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <Standard_Type.hxx>
#include <StepBasic_Document.hxx>
#include <StepBasic_ExternalIdentificationAssignment.hxx>
#include <StepBasic_ProductDefinitionWithAssociatedDocuments.hxx>
#include <StepData_UndefinedEntity.hxx>
#include <StepGeom_CartesianTransformationOperator.hxx>
#include <StepGeom_Curve.hxx>
#include <StepGeom_Direction.hxx>
#include <StepGeom_Placement.hxx>
#include <StepGeom_Point.hxx>
#include <StepGeom_Surface.hxx>
#include <StepGeom_Vector.hxx>
#include <StepRepr_DefinitionalRepresentation.hxx>
#include <StepRepr_FunctionallyDefinedTransformation.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepRepr_RepresentationMap.hxx>
#include <StepShape_Block.hxx>
#include <StepShape_BooleanResult.hxx>
#include <StepShape_EdgeBasedWireframeModel.hxx>
#include <StepShape_FaceBasedSurfaceModel.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_GeometricSet.hxx>
#include <StepShape_GeometricSetSelect.hxx>
#include <StepShape_HalfSpaceSolid.hxx>
#include <StepShape_ManifoldSolidBrep.hxx>
#include <StepShape_MeasureRepresentationItemAndQualifiedRepresentationItem.hxx>
#include <StepShape_QualifiedRepresentationItem.hxx>
#include <StepShape_RightAngularWedge.hxx>
#include <StepShape_RightCircularCone.hxx>
#include <StepShape_RightCircularCylinder.hxx>
#include <StepShape_ShellBasedSurfaceModel.hxx>
#include <StepShape_SolidModel.hxx>
#include <StepShape_Sphere.hxx>
#include <StepShape_TopologicalRepresentationItem.hxx>
#include <StepShape_Torus.hxx>
#include <StepVisual_TessellatedItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <algorithm>
#include <iterator>

namespace spherule::internal {
namespace {

using Model = Handle(Interface_InterfaceModel);
using Entity = Handle(Standard_Transient);

template <typename Types>
bool is_kind_of(const Entity& entity, const Types& types) {
  return std::any_of(std::begin(types), std::end(types),
                     [&](const Handle(Standard_Type) & type) { return entity->IsKind(type); });
}

template <typename Numbers>
bool is_one_of(int number, const Numbers& numbers) {
  return std::find(std::begin(numbers), std::end(numbers), number) != std::end(numbers);
}

// A STEP entity that makes the shape more than OpenCASCADE says it is.
bool is_refused(const Entity& entity) {
  static const Handle(Standard_Type)
      kRefused[] = {STANDARD_TYPE(StepData_UndefinedEntity),
                    STANDARD_TYPE(StepBasic_Document),
                    STANDARD_TYPE(StepBasic_ExternalIdentificationAssignment),
                    STANDARD_TYPE(StepBasic_ProductDefinitionWithAssociatedDocuments),
                    STANDARD_TYPE(StepGeom_CartesianTransformationOperator),
                    STANDARD_TYPE(StepRepr_FunctionallyDefinedTransformation),
                    STANDARD_TYPE(StepShape_Block),
                    STANDARD_TYPE(StepShape_BooleanResult),
                    STANDARD_TYPE(StepShape_HalfSpaceSolid),
                    STANDARD_TYPE(StepShape_RightAngularWedge),
                    STANDARD_TYPE(StepShape_RightCircularCone),
                    STANDARD_TYPE(StepShape_RightCircularCylinder),
                    STANDARD_TYPE(StepShape_Sphere),
                    STANDARD_TYPE(StepShape_Torus),
                    STANDARD_TYPE(StepVisual_TessellatedItem)};
  const bool is_other_solid = entity->IsKind(STANDARD_TYPE(StepShape_SolidModel)) &&
                              !entity->IsKind(STANDARD_TYPE(StepShape_ManifoldSolidBrep));
  const bool is_other_face = entity->IsKind(STANDARD_TYPE(StepShape_Face)) &&
                             !entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface));
  return is_other_solid || is_other_face || is_kind_of(entity, kRefused);
}

// Whether an item of a representation is read, checked as an entity of its own, or no part of a
// shape (notes, styles, measures).
bool is_known_item(const Entity& item) {
  static const Handle(Standard_Type)
      kKnown[] = {STANDARD_TYPE(StepGeom_Curve),
                  STANDARD_TYPE(StepGeom_Direction),
                  STANDARD_TYPE(StepGeom_Placement),
                  STANDARD_TYPE(StepGeom_Point),
                  STANDARD_TYPE(StepGeom_Vector),
                  STANDARD_TYPE(StepShape_EdgeBasedWireframeModel),
                  STANDARD_TYPE(StepShape_FaceBasedSurfaceModel),
                  STANDARD_TYPE(StepShape_GeometricSet),
                  STANDARD_TYPE(StepShape_ManifoldSolidBrep),
                  STANDARD_TYPE(StepShape_MeasureRepresentationItemAndQualifiedRepresentationItem),
                  STANDARD_TYPE(StepShape_QualifiedRepresentationItem),
                  STANDARD_TYPE(StepShape_ShellBasedSurfaceModel),
                  STANDARD_TYPE(StepShape_TopologicalRepresentationItem)};
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
    if (target.IsNull() || !target->IsKind(STANDARD_TYPE(StepGeom_Placement))) refuse(entity);
  }
  const auto representation = Handle(StepRepr_Representation)::DownCast(entity);
  if (representation.IsNull() ||
      entity->IsKind(STANDARD_TYPE(StepRepr_DefinitionalRepresentation))) {
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
  if (is_solid || is_one_of(type, kRefused) ||
      entity->IsKind(STANDARD_TYPE(IGESData_UndefinedEntity))) {
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

}  // namespace

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
    } else if (entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface)) ||
               entity->IsKind(STANDARD_TYPE(StepRepr_MappedItem)) ||
               entity->IsKind(STANDARD_TYPE(StepRepr_NextAssemblyUsageOccurrence))) {
      needed.push_back(entity);
    }
  }
  return needed;
}

}  // namespace spherule::internal
