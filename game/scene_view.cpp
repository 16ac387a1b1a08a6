#include "game/scene_view.hpp"

#include <cmath>

#include "engine/animation/skinning_systems.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/muscle.hpp"

namespace fascicle::game {
namespace {

constexpr std::size_t kCharactersPerChunk = 8;

}  // namespace

void upload_bones(ecs::View<const BoneMatrices, DrawnBones> characters,
                  ecs::Resource<const muscle::DrawTarget> target) {
  Renderer& renderer = *target->renderer;
  parallel::for_range(characters.candidates(), kCharactersPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      characters.visit(i, [&](const BoneMatrices& bones, DrawnBones& drawn) {
        const std::span<glm::mat4> matrices = renderer.rigid_matrices(drawn.group);
        for (std::size_t m = 0; m < matrices.size(); ++m) {
          matrices[m] = bones.world[static_cast<std::size_t>(drawn.bones[m])] * drawn.transforms[m];
        }
        if (bones.teleport_count != drawn.teleport_count) {
          drawn.teleport_count = bones.teleport_count;
          renderer.mark_teleported(drawn.group);
        }
      });
    }
  });
}

void upload_skins(ecs::View<const SkinnedSurface, DrawnSkin> skins, ecs::View<const BoneMatrices> characters,
                  ecs::Resource<const muscle::DrawTarget> target) {
  Renderer& renderer = *target->renderer;
  parallel::for_range(skins.candidates(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      skins.visit(i, [&](const SkinnedSurface& surface, DrawnSkin& drawn) {
        pack_vertices(surface.positions, surface.normals, renderer.skin_vertices(drawn.skin));
        const BoneMatrices* bones = characters.try_get<const BoneMatrices>(drawn.character);
        if (bones != nullptr && bones->teleport_count != drawn.teleport_count) {
          drawn.teleport_count = bones->teleport_count;
          renderer.mark_teleported(drawn.skin);
        }
      });
    }
  });
}

SceneView::SceneView(Simulation& simulation, Renderer& renderer) : simulation_(simulation), renderer_(renderer) {
  simulation_.world().set_resource(muscle::DrawTarget{&renderer});
  simulation_.schedule().add("upload_bones", upload_bones);
  simulation_.schedule().add("upload_skins", upload_skins);
  simulation_.schedule().add("upload_muscles", muscle::upload_muscles);
  simulation_.schedule().add("upload_surface_muscles", muscle::upload_surface_muscles);
  attach();
}

void SceneView::attach() {
  for (const SpawnedCharacter& character : simulation_.characters()) attach_character(character);
  attach_surfaces();
}

void SceneView::attach_character(const SpawnedCharacter& character) {
  ecs::World& world = simulation_.world();

  DrawnBones bones;
  std::vector<MeshHandle> handles;
  for (const muscle::BoneMesh& mesh : character.asset->bone_meshes) {
    const auto [found, is_new] = meshes_.try_emplace(mesh.mesh.get());
    if (is_new) {
      found->second = renderer_.add_mesh(*mesh.mesh);
      mesh_order_.push_back(found->second);
    }
    handles.push_back(found->second);
    bones.bones.push_back(mesh.bone);
    bones.transforms.push_back(mesh.transform);
  }
  if (!handles.empty()) {
    bones.group = renderer_.add_rigid(handles);
    world.add(character.entity, std::move(bones));
  }

  for (const ecs::Entity skin : character.skins) {
    const SkinAsset& asset = *world.get<SkinInstance>(skin).asset;
    world.add(skin, DrawnSkin{renderer_.add_skin(static_cast<std::uint32_t>(asset.size()), asset.indices),
                              character.entity, 0});
  }

  if (character.musculature == ecs::kNoEntity) return;
  muscle::DrawnMuscles drawn;
  if (const auto* detail = world.try_get<muscle::MuscleDetail>(character.musculature)) {
    for (const auto& asset : detail->levels->assets) drawn.levels.push_back(add_level(*asset));
  } else {
    drawn.levels.push_back(add_level(*world.get<muscle::Musculature>(character.musculature).asset));
  }
  world.add(character.musculature, std::move(drawn));
  for (std::uint32_t m = 0; m < character.asset->hidden_muscles.size(); ++m) apply_flags(character, m, 0);
}

void SceneView::attach_surfaces() {
  ecs::World& world = simulation_.world();
  std::vector<ecs::Entity> entities;
  world.view<const muscle::SurfaceMuscle>().each(
      [&](ecs::Entity entity, const muscle::SurfaceMuscle&) { entities.push_back(entity); });
  for (const ecs::Entity entity : entities) {
    const auto& surface = world.get<muscle::SurfaceMuscle>(entity);
    muscle::DrawnSurfaceMuscle drawn;
    drawn.surface = renderer_.add_surface(surface.asset->vertex_count, surface.asset->triangles);
    if (const auto* bundle = world.try_get<muscle::FibreBundle>(entity); bundle != nullptr && bundle->asset) {
      drawn.fibres = renderer_.add_fibres(bundle->asset->count * bundle->asset->points_per_fibre,
                                          muscle::make_fibre_indices(*bundle->asset));
    }
    world.add(entity, drawn);
  }
}

void SceneView::release_surfaces() {
  ecs::World& world = simulation_.world();
  std::vector<ecs::Entity> entities;
  world.view<muscle::DrawnSurfaceMuscle>().each([&](ecs::Entity entity, muscle::DrawnSurfaceMuscle& drawn) {
    renderer_.remove(drawn.surface);
    if (drawn.fibres) renderer_.remove(drawn.fibres);
    entities.push_back(entity);
  });
  for (const ecs::Entity entity : entities) world.remove<muscle::DrawnSurfaceMuscle>(entity);
}

muscle::DrawnMuscles::Level SceneView::add_level(const muscle::MuscleAsset& asset) {
  const auto [shared, is_new] = muscles_.try_emplace(&asset);
  if (is_new) {
    shared->second.topology = renderer_.add_strip_topology(muscle::make_strip_topology(asset));
    shared->second.line_indices = muscle::make_action_line_indices(asset);
    topologies_.push_back(shared->second.topology);
  }
  return {renderer_.add_strips(shared->second.topology),
          renderer_.add_lines(muscle::action_line_vertex_count(asset), shared->second.line_indices)};
}

void SceneView::release() {
  ecs::World& world = simulation_.world();
  release_surfaces();
  for (const SpawnedCharacter& character : simulation_.characters()) {
    if (const DrawnBones* bones = world.try_get<DrawnBones>(character.entity)) {
      renderer_.remove(bones->group);
      world.remove<DrawnBones>(character.entity);
    }
    for (const ecs::Entity skin : character.skins) {
      if (const DrawnSkin* drawn = world.try_get<DrawnSkin>(skin)) renderer_.remove(drawn->skin);
      world.remove<DrawnSkin>(skin);
    }
    if (const muscle::DrawnMuscles* drawn = world.try_get<muscle::DrawnMuscles>(character.musculature)) {
      for (const muscle::DrawnMuscles::Level& level : drawn->levels) {
        renderer_.remove(level.strips);
        renderer_.remove(level.lines);
      }
      world.remove<muscle::DrawnMuscles>(character.musculature);
    }
  }
  for (const StripTopologyHandle topology : topologies_) renderer_.remove(topology);
  for (const MeshHandle mesh : mesh_order_) renderer_.remove(mesh);
  topologies_.clear();
  mesh_order_.clear();
  muscles_.clear();
  meshes_.clear();
}

void SceneView::mark_collision() {
  const ecs::World& world = simulation_.world();
  marks_.lines.clear();
  marks_.points.clear();
  for (const SpawnedCharacter& character : simulation_.characters()) {
    if (character.musculature == ecs::kNoEntity) continue;
    const auto* collision = world.try_get<muscle::MuscleCollision>(character.musculature);
    const auto* contacts = world.try_get<muscle::MuscleContacts>(character.musculature);
    if (collision == nullptr || contacts == nullptr) continue;
    const auto& lines = world.get<muscle::ActionLines>(character.musculature);
    const auto& sections = world.get<muscle::CrossSections>(character.musculature);
    const std::vector<glm::mat4>& bones = world.get<BoneMatrices>(character.entity).world;
    muscle::mark_transversals(*collision, lines, sections, character.asset->collision.transversals, bones, marks_);
    muscle::mark_displacements(*collision, lines, bones, marks_);
    muscle::mark_contacts(*contacts, marks_);
  }
  world.view<const muscle::SurfaceMuscle, const muscle::DrawnSurface>().each(
      [&](const muscle::SurfaceMuscle& surface, const muscle::DrawnSurface& drawn) {
        muscle::mark_attached(*surface.asset, drawn, marks_);
      });
  world.view<const muscle::SurfaceContacts>().each(
      [&](const muscle::SurfaceContacts& contacts) { muscle::mark_surface_contacts(contacts, marks_); });
  muscle::draw_marks(marks_, renderer_);
}

void SceneView::mark_place(std::size_t character, const muscle::SectionTag& tag, std::uint32_t colour) {
  if (character >= simulation_.characters().size()) return;
  const ecs::Entity entity = simulation_.characters()[character].musculature;
  const auto* musculature = simulation_.world().try_get<muscle::Musculature>(entity);
  if (musculature == nullptr || tag.muscle >= musculature->asset->size()) return;
  const muscle::TaggedVertex found = muscle::find_tagged_vertex(*musculature->asset, tag);
  marks_.lines.clear();
  marks_.points.clear();
  muscle::mark_section(*musculature->asset, simulation_.world().get<muscle::ActionLines>(entity),
                       simulation_.world().get<muscle::CrossSections>(entity), tag.muscle, found.section, found.vertex,
                       colour, marks_);
  muscle::draw_marks(marks_, renderer_);
}

OrbitCamera scene_camera(const muscle::SceneAsset& scene) {
  const muscle::SceneCamera& camera = scene.camera;
  return {camera.target, camera.distance, camera.yaw, camera.pitch, camera.field_of_view};
}

muscle::Viewer make_viewer(const OrbitCamera& camera, int height, std::optional<std::uint32_t> level) {
  return {.enabled = true,
          .eye = camera.eye(),
          .pixels_per_radian = 0.5f * static_cast<float>(height) / std::tan(0.5f * camera.fov),
          .level = level};
}

void SceneView::set_muscle_flags(std::size_t scene_index, std::uint32_t muscle, std::uint32_t flags) {
  for (const SpawnedCharacter& character : simulation_.characters()) {
    if (character.scene_index != scene_index || character.musculature == ecs::kNoEntity) continue;
    apply_flags(character, muscle, flags);
  }
}

void SceneView::apply_flags(const SpawnedCharacter& character, std::uint32_t muscle, std::uint32_t flags) {
  const std::vector<std::uint8_t>& hidden = character.asset->hidden_muscles;
  if (muscle < hidden.size() && hidden[muscle] != 0) flags |= kItemHidden;
  const auto& drawn = simulation_.world().get<muscle::DrawnMuscles>(character.musculature);
  for (const muscle::DrawnMuscles::Level& level : drawn.levels) {
    const std::span<StripItem> items = renderer_.strip_items(level.strips);
    if (muscle < items.size()) items[muscle].flags = flags;
  }
}

void SceneView::set_surface_flags(std::size_t scene_index, std::string_view name, std::uint32_t flags) {
  for (const SpawnedCharacter& character : simulation_.characters()) {
    if (character.scene_index != scene_index) continue;
    simulation_.world().view<const muscle::SurfaceMuscle, const muscle::DrawnSurfaceMuscle>().each(
        [&](const muscle::SurfaceMuscle& surface, const muscle::DrawnSurfaceMuscle& drawn) {
          if (surface.character != character.entity || surface.asset->name != name) return;
          const bool visible = (flags & kItemHidden) == 0;
          renderer_.set_visible(drawn.surface, visible);
          if (drawn.fibres) renderer_.set_visible(drawn.fibres, visible);
          renderer_.set_highlighted(drawn.surface, (flags & kItemHighlighted) != 0);
        });
  }
}

}  // namespace fascicle::game
