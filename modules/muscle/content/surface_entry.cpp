// One surface muscle of a character file. Ranges: surface_limits.hpp.

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "modules/muscle/asset/muscle_limits.hpp"
#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/surface_limits.hpp"

namespace fascicle::muscle {

namespace {

using Choice = SurfaceAttachmentEntry::Choice;

constexpr float kMillimetre = 1.0e-3f;  // m

// Whole numbers of a list, those that are wrong left out.
std::vector<std::uint32_t> read_vertices(const JsonNode& list, Diagnostics& diagnostics) {
  std::vector<std::uint32_t> vertices;
  for (const JsonNode node : list) {
    std::uint32_t vertex = 0;
    if (node.read(vertex, diagnostics)) vertices.push_back(vertex);
  }
  return vertices;
}

void read_plane(const JsonNode& node, SurfaceAttachmentEntry& entry, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  const JsonNode normal = object.require("normal");
  glm::vec3 direction(0.0f);
  if (normal.exists() && normal.read(direction, context.diagnostics, kPlaneRange)) {
    const double length = glm::length(glm::dvec3(direction));
    if (length > 0.0) {
      entry.normal = glm::dvec3(direction) / length;
    } else {
      normal.error(context.diagnostics, "a plane's normal has no length",
                   "point it to the side that is attached, as in [0, 0, 1]");
    }
  }
  object.require("at", entry.offset, kPlaneRange);
  std::size_t space = 0;
  if (object.optional_choice("space", space, {"mesh", "character"})) entry.plane_in_rest_space = space == 1;
  finish_object(object, "plane", context);
}

void read_near(const JsonNode& node, SurfaceAttachmentEntry& entry, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  object.require("position", entry.point, kPositionRange);
  float radius = 0.0f;
  if (object.require("radius_mm", radius, kAttachmentDistanceRange)) entry.distance = kMillimetre * radius;
  finish_object(object, "near", context);
}

SurfaceAttachmentEntry read_surface_attachment(const JsonNode& node, const ReadContext& context) {
  SurfaceAttachmentEntry entry;
  entry.node = node;
  JsonObject object(node, context.diagnostics);
  entry.bone = read_name(object, "bone", true);
  std::size_t end = 0;
  if (object.require_choice("end", end, {"origin", "insertion"})) entry.origin = end == 0;
  int choices = 0;
  const auto choose = [&](std::string_view field, Choice choice) {
    const JsonNode found = object.optional(field);
    if (found.exists()) {
      ++choices;
      entry.choice = choice;
    }
    return found;
  };
  if (const JsonNode within = choose("within_mm", Choice::kWithin); within.exists()) {
    float distance = 0.0f;
    if (within.read(distance, context.diagnostics, kAttachmentDistanceRange)) {
      entry.distance = kMillimetre * distance;
    } else {
      entry.choice = Choice::kNone;
    }
  }
  if (const JsonNode near = choose("near", Choice::kNear); near.exists()) read_near(near, entry, context);
  if (const JsonNode plane = choose("beyond", Choice::kBeyond); plane.exists()) read_plane(plane, entry, context);
  if (const JsonNode list = choose("vertices", Choice::kVertices);
      list.exists() && list.require_array(context.diagnostics, 1)) {
    entry.vertices = read_vertices(list, context.diagnostics);
  }
  if (object.valid() && choices != 1) {
    node.error(context.diagnostics,
               choices == 0 ? "nothing says which vertices are attached" : "several fields say which vertices are attached",
               "give one: \"within_mm\" of the bone's meshes, \"near\" a point, \"beyond\" a plane, or \"vertices\"");
    entry.choice = Choice::kNone;
  }
  finish_object(object, "surface_attachment", context);
  return entry;
}

// Numbers are those of the mesh's file, unless the entry says otherwise.
FibresEntry read_fibres(const JsonNode& node, const MeshEntry& mesh, const ReadContext& context) {
  FibresEntry entry;
  entry.node = node;
  entry.unit = mesh.unit;
  entry.transform = mesh.transform;
  JsonObject object(node, context.diagnostics);
  entry.file = read_name(object, "file", false);
  const JsonNode points = object.optional_array("points", 2, kMostFibrePoints);
  for (const JsonNode point : points) {
    glm::vec3 place(0.0f);
    if (point.read(place, context.diagnostics, kFibrePointRange)) entry.points.push_back(place);
  }
  if (object.valid() && object.optional("file").exists() == object.optional("points").exists()) {
    node.error(context.diagnostics,
               points.exists() ? "the fibres have both 'file' and 'points'" : "the fibres have neither 'file' nor 'points'",
               "name a .vtk file of lines, or write one fibre's points");
  }
  object.optional("head", entry.head, kHeadRange);
  read_unit(object, entry.unit);
  entry.own_unit = object.optional("unit").exists();
  read_placement(object, entry.transform);
  finish_object(object, "fibres", context);
  return entry;
}

FibreBundleSettings read_inner_fibres(const JsonNode& node, const ReadContext& context) {
  FibreBundleSettings fibres;
  JsonObject object(node, context.diagnostics);
  std::size_t choice = 0;
  if (object.require_choice("method", choice, {"isocontours", "surface"})) {
    fibres.method = choice == 0 ? FibreMethod::kIsocontour : FibreMethod::kSurface;
  }
  if (object.optional_choice("arrangement", choice, {"parallel", "pennate", "fan"})) {
    constexpr FibreArrangement kArrangements[] = {FibreArrangement::kParallel, FibreArrangement::kPennate,
                                                  FibreArrangement::kFan};
    fibres.arrangement = kArrangements[choice];
  }
  object.optional("count", fibres.count, kFibreCountRange);
  object.optional("points", fibres.points, kPointsPerFibreRange);
  object.optional("pennation", fibres.pennation, kFibrePennationRange);
  finish_object(object, "inner_fibres", context);
  return fibres;
}

void read_settings(const JsonNode& node, SurfaceSettings& settings, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  object.optional("substeps", settings.substeps, kSurfaceSubstepsRange);
  object.optional("density", settings.density, kDensityRange);
  object.optional("stretch_compliance", settings.stretch_compliance, kStretchComplianceRange);
  object.optional("along_fibres", settings.along_fibres, kAlongFibresRange);
  object.optional("bend_compliance", settings.bend_compliance, kBendComplianceRange);
  object.optional("volume_compliance", settings.volume_compliance, kVolumeComplianceRange);
  object.optional("anchor_compliance", settings.anchor_compliance, kAnchorComplianceRange);
  object.optional("damping", settings.damping, kDampingRange);
  object.optional("viscosity", settings.viscosity, kDampingRange);
  float distance = 0.0f;
  if (object.optional("contact_distance_mm", distance, kContactDistanceRange)) {
    settings.contact_distance = kMillimetre * distance;
  }
  object.optional("friction", settings.friction, kFrictionRange);
  object.optional("collide_with_bones", settings.collide_with_bones);
  object.optional("collide_with_itself", settings.collide_with_itself);
  object.optional("collide_with_muscles", settings.collide_with_muscles);
  finish_object(object, "surface_settings", context);
}

}  // namespace

SurfaceMuscleEntry read_surface_muscle_entry(const JsonNode& node, const ReadContext& context) {
  const std::size_t errors_before = context.diagnostics.errors.size();
  SurfaceMuscleEntry entry;
  entry.node = node;
  JsonObject object(node, context.diagnostics);
  entry.name = read_name(object, "name", true);
  object.optional("mirror", entry.mirror);
  if (const JsonNode mesh = object.require("mesh"); mesh.exists()) entry.mesh = read_mesh_entry(mesh, context);
  entry.piece_node = object.optional("piece");
  if (entry.piece_node.exists()) entry.piece_node.read(entry.piece, context.diagnostics, kPieceRange);
  entry.frame = read_name(object, "frame", false);
  for (const JsonNode one : object.optional_array("attachments", 0, kMostSurfaceAttachments)) {
    entry.attachments.push_back(read_surface_attachment(one, context));
  }
  for (const JsonNode one : object.optional_array("fibres", 0, kMostFibreEntries)) {
    entry.fibres.push_back(read_fibres(one, entry.mesh, context));
  }
  if (const JsonNode inner = object.optional("inner_fibres"); inner.exists()) {
    entry.inner_fibres = read_inner_fibres(inner, context);
    entry.inner_fibres_node = inner;
  }
  entry.all_bones = !object.optional("bones").exists();
  for (const JsonNode one : object.optional_array("bones", 0, 10000)) {
    NameEntry bone;
    if (!one.read(bone.text, context.diagnostics)) continue;
    bone.node = one;
    entry.bones.push_back(std::move(bone));
  }
  entry.driver = read_name(object, "driver", false);
  object.optional("hide_driver", entry.hide_driver);
  object.optional("free", entry.free);
  if (const JsonNode settings = object.optional("settings"); settings.exists()) {
    read_settings(settings, entry.settings, context);
  }
  read_surface_solver(object, entry, context);
  finish_object(object, "surface_muscle", context);
  if (entry.free && !entry.attachments.empty()) {
    object.optional("free").error(context.diagnostics, "the muscle is free, and it has attachments",
                                  "leave out one of the two");
  }
  entry.sound = context.diagnostics.errors.size() == errors_before;
  return entry;
}

}  // namespace fascicle::muscle
