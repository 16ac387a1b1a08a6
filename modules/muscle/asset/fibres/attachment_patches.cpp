#include "modules/muscle/asset/fibres/attachment_patches.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "modules/muscle/asset/fibres/fibre_faults.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kLeastHeadShare = 10;  // a patch with less than a tenth of the largest one's vertices is no head

// Connected sets of vertices with the same mark.
struct Pieces {
  std::vector<std::uint32_t> of;         // by vertex: the lowest vertex of its piece
  std::vector<std::uint32_t> size;       // by lowest vertex
};

Pieces find_pieces(std::span<const std::uint32_t> triangles, const std::vector<Patch>& mark) {
  Pieces pieces;
  pieces.of.resize(mark.size());
  for (std::uint32_t v = 0; v < mark.size(); ++v) pieces.of[v] = v;
  const auto root = [&](std::uint32_t v) {
    for (; pieces.of[v] != v; v = pieces.of[v]) pieces.of[v] = pieces.of[pieces.of[v]];
    return v;
  };
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[t + k], b = triangles[t + (k + 1) % 3];
      if (mark[a] != mark[b]) continue;
      const std::uint32_t i = root(a), j = root(b);
      pieces.of[std::max(i, j)] = std::min(i, j);
    }
  }
  pieces.size.assign(mark.size(), 0);
  for (std::uint32_t v = 0; v < mark.size(); ++v) ++pieces.size[pieces.of[v] = root(v)];
  return pieces;
}

// The pieces of one end that count as heads, each attachment's largest, the largest of all first.
std::vector<std::uint32_t> find_heads(const SurfaceAsset& surface, const Pieces& pieces, bool origin) {
  std::vector<std::uint32_t> heads;
  for (std::uint32_t a = 0; a < surface.attachments.size(); ++a) {
    if (surface.attachments[a].origin != origin) continue;
    std::uint32_t largest = kNone;
    for (const AttachedVertex& attached : surface.attached) {
      const std::uint32_t piece = pieces.of[attached.vertex];
      if (attached.attachment == a && (largest == kNone || pieces.size[piece] > pieces.size[largest])) largest = piece;
    }
    if (largest != kNone && std::ranges::find(heads, largest) == heads.end()) heads.push_back(largest);
  }
  std::ranges::stable_sort(heads, [&](std::uint32_t a, std::uint32_t b) { return pieces.size[a] > pieces.size[b]; });
  while (heads.size() > 1 && pieces.size[heads.back()] * kLeastHeadShare < pieces.size[heads.front()]) heads.pop_back();
  return heads;
}

// Pieces between that touch one patch alone are holes in it. True: something is left that touches both.
bool fill_holes(std::span<const std::uint32_t> triangles, AttachmentPatches& patches) {
  const Pieces pieces = find_pieces(triangles, patches.of);
  std::vector<std::array<bool, 3>> touches(patches.of.size(), {false, false, false});
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t a = triangles[i], b = triangles[i % 3 == 2 ? i - 2 : i + 1];
    if (patches.of[a] == Patch::kBetween) touches[pieces.of[a]][static_cast<std::size_t>(patches.of[b])] = true;
    if (patches.of[b] == Patch::kBetween) touches[pieces.of[b]][static_cast<std::size_t>(patches.of[a])] = true;
  }
  const auto joins = [&](std::uint32_t piece) { return touches[piece][1] && touches[piece][2]; };
  bool any = false;
  for (std::uint32_t v = 0; v < patches.of.size(); ++v) {
    const std::uint32_t piece = pieces.of[v];
    if (patches.of[v] != Patch::kBetween) continue;
    if (joins(piece)) {
      any = true;
    } else {
      patches.of[v] = touches[piece][1] ? Patch::kOrigin : Patch::kInsertion;
      ++patches.filled;
    }
  }
  return any;
}

}  // namespace

Result<AttachmentPatches> find_attachment_patches(const SurfaceAsset& surface) {
  AttachmentPatches patches;
  patches.of.assign(surface.vertex_count, Patch::kBetween);
  std::vector<Patch> attached(surface.vertex_count, Patch::kBetween);
  for (const AttachedVertex& a : surface.attached)
    attached[a.vertex] = surface.attachments[a.attachment].origin ? Patch::kOrigin : Patch::kInsertion;
  const Pieces pieces = find_pieces(surface.triangles, attached);
  Diagnostics faults;
  std::uint32_t kept = 0;
  for (const bool origin : {true, false}) {
    const char* end = origin ? "origin" : "insertion";
    const std::vector<std::uint32_t> heads = find_heads(surface, pieces, origin);
    if (heads.empty()) {
      faults.errors.push_back(fibre_fault(surface, fmt::format("no vertex is attached as its {}", end),
                                          "fibres run from origin to insertion: attach vertices to a bone as each"));
    } else if (heads.size() > 1) {
      faults.errors.push_back(fibre_fault(
          surface, fmt::format("its {} is {} patches apart from each other: it has several heads", end, heads.size()),
          "the isocontour method takes one head: give fibres on the surface and use the method \"surface\""));
    } else {
      for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
        if (attached[v] == Patch::kBetween || pieces.of[v] != heads.front()) continue;
        patches.of[v] = attached[v];
        ++kept;
      }
    }
  }
  if (!faults.ok()) return faults;
  patches.left_out = static_cast<std::uint32_t>(surface.attached.size()) - kept;
  if (!fill_holes(surface.triangles, patches))
    return fibre_fault(surface, "nothing lies between its origin and its insertion",
                       "leave vertices between them that are attached to no bone");
  return patches;
}

}  // namespace fascicle::muscle
