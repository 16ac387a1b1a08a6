#include "tools/fascicle_cook/draw_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/finite.hpp"
#include "engine/render/headless.hpp"
#include "engine/render/overlay.hpp"
#include "engine/render/renderer.hpp"
#include "modules/muscle/asset/fit/compare_fit.hpp"

namespace fascicle::cook {
namespace {

constexpr int kSides = 4;
constexpr int kOversampling = 2;    // pixels drawn a side of one kept
constexpr float kRingWidth = 2.0f;  // pixels drawn
constexpr float kDotSize = 9.0f;

// What a section's stretch is painted as, in the order of the picture's head.
enum Paint { kFitted, kRescued, kPartial, kMissed, kOutside, kUnfitted, kPaints };

struct PaintStyle {
  const char* text;
  glm::vec4 colour;  // sRGB
};
constexpr std::array<PaintStyle, kPaints> kStyles = {{{"fitted", {0.30f, 0.72f, 0.36f, 1.0f}},
                                                      {"rescued, fitted", {0.27f, 0.55f, 0.95f, 1.0f}},
                                                      {"some rays missed", {0.95f, 0.84f, 0.25f, 1.0f}},
                                                      {"all rays missed", {0.96f, 0.55f, 0.15f, 1.0f}},
                                                      {"centre outside", {0.90f, 0.16f, 0.16f, 1.0f}},
                                                      {"not fitted", {0.52f, 0.52f, 0.54f, 1.0f}}}};
constexpr glm::vec3 kMeshColour{0.62f, 0.70f, 0.82f};  // linear
constexpr float kMeshOpacity = 0.22f;

Paint paint_of(const muscle::SectionReport& section) {
  switch (section.outcome) {
    case muscle::SectionOutcome::kFitted: return section.rescued ? kRescued : kFitted;
    case muscle::SectionOutcome::kPartial: return kPartial;
    case muscle::SectionOutcome::kMissed: return kMissed;
    case muscle::SectionOutcome::kOutside: return kOutside;
  }
  return kUnfitted;
}

Paint paint_of(const PicturedMuscle& muscle, std::uint32_t section) {
  return section < muscle.sections.size() ? paint_of(muscle.sections[section]) : kUnfitted;
}

// Unit, by the triangles' areas.
std::vector<glm::vec3> smooth_normals(const TriangleMesh& mesh) {
  std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]];
    const glm::vec3 normal = glm::cross(b - a, mesh.positions[mesh.indices[i + 2]] - a);
    for (std::size_t corner = i; corner < i + 3; ++corner) normals[mesh.indices[corner]] += normal;
  }
  for (glm::vec3& normal : normals) {
    const float length = glm::length(normal);
    normal = length > 0.0f && std::isfinite(length) ? normal / length : glm::vec3(0, 1, 0);
  }
  return normals;
}

// The muscle's rest surface with its rows tripled: each section's stretch reaches half-way to its neighbours, so that
// it can have a colour of its own.
struct Stretches {
  StripTopology topology;
  std::vector<DrawVertex> vertices;
  std::vector<StripRow> rows;
};

Stretches make_stretches(const PicturedMuscle& pictured) {
  const muscle::MuscleLayout& layout = pictured.asset->muscles[pictured.muscle];
  const std::uint32_t around = layout.section_vertices, sections = layout.section_count;
  const TriangleMesh surface = muscle::rest_surface(*pictured.asset, pictured.muscle);
  const std::vector<glm::vec3> normals = smooth_normals(surface);
  Stretches result;
  append_tube_vertices(3 * sections, around, result.topology);
  result.topology.item_count = kPaints;
  for (std::uint32_t k = 0; k < sections; ++k) {
    for (const int side : {-1, 0, 1}) {
      const std::uint32_t other =
          side < 0 ? std::max(k, 1u) - 1 : std::min(k + static_cast<std::uint32_t>(side), sections - 1);
      for (std::uint32_t i = 0; i < around; ++i) {
        const std::uint32_t a = k * around + i, b = other * around + i;
        result.vertices.push_back(
            {0.5f * (surface.positions[a] + surface.positions[b]), pack_normal(normals[a] + normals[b])});
      }
      result.rows.push_back({1.0f, static_cast<std::uint32_t>(paint_of(pictured, k))});
    }
    // Two strips a section; none over the seam to the next one's.
    for (const std::uint32_t row : {3 * k, 3 * k + 1}) {
      for (std::uint32_t i = 0; i <= around; ++i) {
        result.topology.strip_indices.push_back((row + 1) * around + i % around);
        result.topology.strip_indices.push_back(row * around + i % around);
      }
      result.topology.strip_indices.push_back(kPrimitiveRestart);
    }
  }
  for (const std::uint32_t end : {0u, 1u}) {
    const std::uint32_t centre = 3 * sections * around + end, first = end == 0 ? 0 : (3 * sections - 1) * around;
    const std::uint32_t cap = sections * around + end;
    result.vertices.push_back({surface.positions[cap], pack_normal(normals[cap])});
    result.topology.fan_indices.push_back(centre);
    for (std::uint32_t i = 0; i <= around; ++i) {
      result.topology.fan_indices.push_back(first + (end == 0 ? around - i : i) % around);
    }
    result.topology.fan_indices.push_back(kPrimitiveRestart);
  }
  return result;
}

// Everything in one renderer, drawn from all sides.
class FitArtist {
 public:
  FitArtist(const FitPicture& picture, Renderer& renderer, Overlay& overlay)
      : picture_(picture), renderer_(renderer), overlay_(overlay) {
    renderer_.begin_step();
    std::map<const TriangleMesh*, bool> drawn;
    for (const PicturedMuscle& muscle : picture_.muscles) {
      add_muscle(muscle);
      if (muscle.mesh != nullptr && !std::exchange(drawn[muscle.mesh], true)) add_mesh(*muscle.mesh);
    }
  }

  Image draw() {
    glm::vec2 largest(0.0f);
    for (int side = 0; side < kSides; ++side) largest = glm::max(largest, 2.0f * look_from(side).half_size);
    const float aspect = largest.y > 0.0f ? std::clamp(largest.x / largest.y, 0.4f, 2.5f) : 1.0f;
    const int columns = aspect < 1.0f ? kSides : kSides / 2;
    const int height = std::clamp(picture_.height, 64, 4096) / (columns == kSides ? 1 : 2);
    const int width = std::max(static_cast<int>(std::lround(aspect * static_cast<float>(height))), 16);
    std::vector<Image> sides;
    for (int side = 0; side < kSides; ++side) sides.push_back(draw_side(side, width, height));
    constexpr int kGap = 4;
    Image sheet = contact_sheet(sides, columns, kGap);
    Image head = draw_head(sheet.width);
    head.rgb.insert(head.rgb.end(), sheet.rgb.begin(), sheet.rgb.end());
    head.height += sheet.height;
    return head;
  }

 private:
  void add_muscle(const PicturedMuscle& pictured) {
    const Stretches stretches = make_stretches(pictured);
    const StripHandle strips = renderer_.add_strips(renderer_.add_strip_topology(stretches.topology));
    std::ranges::copy(stretches.vertices, renderer_.strip_vertices(strips).begin());
    std::ranges::copy(stretches.rows, renderer_.strip_rows(strips).begin());
    const std::span<StripItem> items = renderer_.strip_items(strips);
    for (std::size_t i = 0; i < kPaints; ++i) items[i].belly_colour = pack_colour(kStyles[i].colour);
    const TriangleMesh surface = muscle::rest_surface(*pictured.asset, pictured.muscle);
    points_.insert(points_.end(), surface.positions.begin(), surface.positions.end());
    const std::uint32_t sections = pictured.asset->muscles[pictured.muscle].section_count;
    for (std::uint32_t k = 0; k < sections; ++k) ++counts_[paint_of(pictured, k)];
  }

  void add_mesh(const TriangleMesh& mesh) {
    if (mesh.indices.size() < 3) return;
    const SkinHandle skin = renderer_.add_skin(static_cast<std::uint32_t>(mesh.positions.size()), mesh.indices);
    pack_vertices(mesh.positions, smooth_normals(mesh), renderer_.skin_vertices(skin));
    std::ranges::copy_if(mesh.positions, std::back_inserter(points_), is_finite<float>);
  }

  // Rings and dots last for one picture.
  void add_marks() {
    for (const PicturedMuscle& pictured : picture_.muscles) {
      const muscle::MuscleLayout& layout = pictured.asset->muscles[pictured.muscle];
      const TriangleMesh surface = muscle::rest_surface(*pictured.asset, pictured.muscle);
      for (std::uint32_t k = 0; k < layout.section_count; ++k) {
        const glm::vec4 colour = kStyles[paint_of(pictured, k)].colour;
        const std::uint32_t dark = pack_colour({0.35f * glm::vec3(colour), 1.0f});
        const glm::vec3* row = &surface.positions[std::size_t{k} * layout.section_vertices];
        for (std::uint32_t i = 0; i < layout.section_vertices; ++i) {
          renderer_.add_line(row[i], row[(i + 1) % layout.section_vertices], dark);
        }
        renderer_.add_point(muscle::rest_point(*pictured.asset, pictured.muscle, k), pack_colour(colour), kDotSize);
      }
    }
  }

  // A side's view before perspective: what all points take of it.
  struct Look {
    OrbitCamera camera;  // its target is the middle of what is seen
    glm::vec3 right, up, back;
    glm::vec2 half_size{0.0f};  // m
  };

  Look look_from(int side) const {
    Look look;
    look.camera = {glm::vec3(0.0f), 1.0f, 1.5707963f * static_cast<float>(side), 0.12f, 0.35f};
    look.back = glm::normalize(look.camera.eye());
    look.right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), look.back));
    look.up = glm::cross(look.back, look.right);
    if (points_.empty()) return look;
    constexpr float kMost = std::numeric_limits<float>::max();
    glm::vec3 lower(kMost), upper(-kMost);
    for (const glm::vec3& p : points_) {
      const glm::vec3 seen(glm::dot(p, look.right), glm::dot(p, look.up), glm::dot(p, look.back));
      lower = glm::min(lower, seen);
      upper = glm::max(upper, seen);
    }
    const glm::vec3 middle = 0.5f * (lower + upper);
    look.camera.target = middle.x * look.right + middle.y * look.up + middle.z * look.back;
    look.half_size = 0.5f * glm::vec2(upper - lower);
    return look;
  }

  Image draw_side(int side, int width, int height) {
    constexpr float kMargin = 1.04f;
    const Look look = look_from(side);
    DrawView view;
    view.camera = look.camera;
    // So near that all points are just in view.
    const float tall = std::tan(0.5f * look.camera.fov);
    const float wide = tall * static_cast<float>(width) / static_cast<float>(height);
    float distance = 0.0f;
    for (const glm::vec3& point : points_) {
      const glm::vec3 p = point - look.camera.target;
      const float needed = std::max(std::abs(glm::dot(p, look.up)) / tall, std::abs(glm::dot(p, look.right)) / wide);
      distance = std::max(distance, glm::dot(p, look.back) + kMargin * needed);
    }
    view.camera.distance = std::clamp(distance, 0.02f, 200.0f);
    view.skin_opacity = kMeshOpacity;
    view.skin_colour = kMeshColour;
    view.ground = view.shadow = false;
    view.lines_through = 0.5f;
    view.line_width = kRingWidth;
    add_marks();
    renderer_.resize(kOversampling * width, kOversampling * height);
    renderer_.draw(view);
    return shrink(renderer_.read_image(), kOversampling);
  }

  // The title, and what the colours mean.
  Image draw_head(int width) {
    // Pixels drawn.
    const float text = kOversampling * std::clamp(static_cast<float>(width) / 90.0f, 14.0f, 28.0f);
    const float line = 1.7f * text, margin = 0.7f * text;
    std::string title = picture_.title;
    if (picture_.muscles.size() == 1) {
      const std::string& name = picture_.muscles[0].asset->muscles[picture_.muscles[0].muscle].name;
      if (name != title) title += ": " + name;
    }
    std::vector<Caption> captions = {{{margin, 0.25f * line}, title, 0xffffffffu, false}};
    const float right = static_cast<float>(kOversampling * width) - margin;
    glm::vec2 at(margin, 1.25f * line);
    const auto add = [&](const std::string& words, const glm::vec4& colour) {
      const float taken = overlay_.text_width(words, text) + 2.2f * text;
      if (at.x > margin && at.x + taken > right) at = {margin, at.y + line};
      captions.push_back({at, words, pack_colour(colour), true});
      at.x += taken;
    };
    for (std::size_t paint = 0; paint < kPaints; ++paint) {
      if (counts_[paint] > 0) add(fmt::format("{} {}", kStyles[paint].text, counts_[paint]), kStyles[paint].colour);
    }
    add("anatomical mesh", {0.62f, 0.68f, 0.76f, 0.6f});
    DrawView empty;
    empty.strips = empty.skins = empty.lines = empty.ground = empty.shadow = false;
    renderer_.resize(kOversampling * width, kOversampling * static_cast<int>((at.y + line) / kOversampling));
    renderer_.draw(empty);
    overlay_.draw_captions(captions, text, renderer_);
    return shrink(renderer_.read_image(), kOversampling);
  }

  const FitPicture& picture_;
  Renderer& renderer_;
  Overlay& overlay_;
  std::vector<glm::vec3> points_;  // of everything drawn
  std::array<std::uint32_t, kPaints> counts_{};
};

}  // namespace

Diagnostics draw_fit(const FitPicture& picture, const std::filesystem::path& png) {
  if (picture.muscles.empty()) {
    return {{{png.string(), 0, 0, "", "there is no muscle to draw", "choose one whose muscles have meshes"}}, {}};
  }
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
  const auto written = write_png(FitArtist(picture, **renderer, **overlay).draw(), png);
  return written.diagnostics();
}

}  // namespace fascicle::cook
