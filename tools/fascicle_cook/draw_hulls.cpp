#include "tools/fascicle_cook/draw_hulls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "engine/geometry/finite.hpp"
#include "engine/geometry/mesh_edges.hpp"
#include "engine/geometry/principal_axes.hpp"
#include "engine/render/headless.hpp"
#include "engine/render/overlay.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/screenshot.hpp"

namespace fascicle::cook {
namespace {

constexpr int kOversampling = 2;  // pixels drawn a side of one kept
constexpr float kMargin = 1.1f, kHeadroom = 0.05f;  // of half the picture; the latter for the caption
constexpr float kFieldOfView = 0.25f;  // rad: nearly parallel, so that sizes compare
constexpr float kGlass = 0.16f;
constexpr glm::vec3 kMuscleColour{0.46f, 0.13f, 0.11f}, kHullColour{0.62f, 0.70f, 0.82f};  // linear
constexpr std::uint32_t kEdgeColour = 0xffffe8d8u, kVertexColour = 0xff30c8ffu;

TriangleMesh turned(const TriangleMesh& mesh, const PrincipalAxes& axes) {
  // Longest: y, second: x, shortest: towards the eye.
  const glm::dvec3 right = axes.axes[1], up = axes.axes[0], back = glm::cross(right, up);
  TriangleMesh result{.name = {}, .positions = {}, .normals = {}, .indices = mesh.indices};
  for (const glm::vec3& position : mesh.positions) {
    const glm::dvec3 p = glm::dvec3(position) - axes.centre;
    result.positions.emplace_back(glm::dot(p, right), glm::dot(p, up), glm::dot(p, back));
  }
  return result;
}

// Every triangle with corners of its own, so that each is seen to be flat.
TriangleMesh apart(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (const std::uint32_t index : mesh.indices) {
    result.indices.push_back(static_cast<std::uint32_t>(result.positions.size()));
    result.positions.push_back(mesh.positions[index]);
  }
  for (std::size_t i = 0; i + 2 < result.positions.size(); i += 3) {
    const glm::vec3 &a = result.positions[i], &b = result.positions[i + 1], &c = result.positions[i + 2];
    const glm::vec3 area = glm::cross(b - a, c - a);
    const float size = glm::length(area);
    result.normals.insert(result.normals.end(), 3, size > 0.0f ? area / size : glm::vec3(0, 1, 0));
  }
  return result;
}

struct Cell {
  TriangleMesh fine, hull;
  glm::vec3 lower{0.0f}, upper{0.0f};  // of the hull
};

class HullArtist {
 public:
  HullArtist(Renderer& renderer, Overlay& overlay) : renderer_(renderer), overlay_(overlay) {}

  Image draw(const Cell& cell, const glm::vec2& half_size, const std::string& caption, int width, int height) {
    DrawView view;
    view.camera = {0.5f * (cell.lower + cell.upper), 1.0f, 0.0f, 0.0f, kFieldOfView};
    view.camera.target.y += kHeadroom * half_size.y;
    const float tall = std::tan(0.5f * kFieldOfView), wide = tall * static_cast<float>(width) / static_cast<float>(height);
    const float away = std::max(half_size.y / tall, half_size.x / wide);
    view.camera.distance = std::clamp(kMargin * away + 0.5f * (cell.upper.z - cell.lower.z), 0.02f, 200.0f);
    view.skin_opacity = kGlass;
    view.skin_colour = kHullColour;
    view.mesh_colour = kMuscleColour;
    view.ground = view.shadow = false;
    view.lines_through = 0.0f;
    view.line_width = 1.2f * kOversampling;

    const MeshHandle mesh = renderer_.add_mesh(cell.fine);
    const RigidHandle group = renderer_.add_rigid(std::array{mesh});
    const TriangleMesh flat = apart(cell.hull);
    const SkinHandle skin = renderer_.add_skin(static_cast<std::uint32_t>(flat.positions.size()), flat.indices);
    renderer_.begin_step();
    renderer_.rigid_matrices(group)[0] = glm::mat4(1.0f);
    pack_vertices(flat.positions, flat.normals, renderer_.skin_vertices(skin));
    add_edges(cell.hull, view.camera.eye());
    renderer_.resize(kOversampling * width, kOversampling * height);
    renderer_.draw(view);
    constexpr float kText = 16.0f * kOversampling;
    const float room = 0.94f * static_cast<float>(kOversampling * width) / std::max(overlay_.text_width(caption, kText), 1.0f);
    const float text = kText * std::min(room, 1.0f);
    overlay_.draw_captions(std::array{Caption{{0.6f * text, 0.5f * text}, caption, 0xffffffffu, false}}, text, renderer_);
    Image image = shrink(renderer_.read_image(), kOversampling);
    renderer_.remove(skin);
    renderer_.remove(group);
    renderer_.remove(mesh);
    return image;
  }

 private:
  // Those of triangles that face the eye.
  void add_edges(const TriangleMesh& hull, const glm::vec3& eye) {
    const auto faces = [&](std::uint32_t side) {
      const std::uint32_t first = side - side % 3;
      const glm::vec3 &a = hull.positions[hull.indices[first]], &b = hull.positions[hull.indices[first + 1]],
                      &c = hull.positions[hull.indices[first + 2]];
      return glm::dot(glm::cross(b - a, c - a), eye - a) > 0.0f;
    };
    const MeshEdges edges = find_edges(hull.indices, hull.positions.size());
    for (std::size_t e = 0; e < edges.count(); ++e) {
      const auto sides = edges.sides_of(e);
      if (std::ranges::none_of(sides, faces)) continue;
      const glm::vec3 &from = hull.positions[hull.indices[sides[0]]], &to = hull.positions[hull.indices[next_side(sides[0])]];
      renderer_.add_line(from, to, kEdgeColour);
      for (const glm::vec3& end : {from, to}) renderer_.add_point(end, kVertexColour, 3.5f * kOversampling);
    }
  }

  Renderer& renderer_;
  Overlay& overlay_;
};

}  // namespace

Diagnostics draw_hulls(std::span<const PicturedHull> hulls, std::size_t columns, int height,
                       const std::filesystem::path& png) {
  if (hulls.empty() || columns == 0) return {{{png.string(), 0, 0, {}, "there is no hull to draw", "choose a muscle"}}, {}};
  auto headless = Headless::create();
  if (!headless) return headless.diagnostics();
  RendererOptions options;
  options.samples = 0;  // drawn larger and shrunk instead
  options.shadow_size = 0;
  options.time_passes = false;
  auto renderer = Renderer::create(options);
  if (!renderer) return renderer.diagnostics();
  auto overlay = Overlay::create();
  if (!overlay) return overlay.diagnostics();

  std::vector<Cell> cells;
  std::vector<glm::vec2> half_sizes((hulls.size() + columns - 1) / columns, glm::vec2(0.0f));  // by row
  float aspect = 0.0f;
  for (std::size_t i = 0; i < hulls.size(); ++i) {
    const PrincipalAxes axes = principal_axes(*hulls[i].fine);
    Cell cell{turned(*hulls[i].fine, axes), turned(*hulls[i].hull, axes), glm::vec3(0.0f), glm::vec3(0.0f)};
    if (!cell.hull.positions.empty()) cell.lower = cell.upper = cell.hull.positions.front();
    for (const glm::vec3& position : cell.hull.positions) {
      if (!is_finite(position)) continue;
      cell.lower = glm::min(cell.lower, position);
      cell.upper = glm::max(cell.upper, position);
    }
    glm::vec2& half_size = half_sizes[i / columns];
    half_size = glm::max(half_size, 0.5f * glm::vec2(cell.upper - cell.lower));
    cells.push_back(std::move(cell));
  }
  for (const glm::vec2& half_size : half_sizes) aspect = std::max(aspect, half_size.y > 0.0f ? half_size.x / half_size.y : 1.0f);
  const int tall = std::clamp(height, 64, 4096);
  const int wide = std::max(16, static_cast<int>(static_cast<float>(tall) * std::clamp(aspect, 0.4f, 2.0f)));
  HullArtist artist(**renderer, **overlay);
  std::vector<Image> images;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    images.push_back(artist.draw(cells[i], half_sizes[i / columns], hulls[i].caption, wide, tall));
  }
  const auto written = write_png(contact_sheet(images, static_cast<int>(std::min(columns, images.size()))), png);
  return written.diagnostics();
}

}  // namespace fascicle::cook
