// Levels of detail of one character's muscles: assets of the same muscles, finest first, and what morphs each into the
// next coarser one, so that a level can change while it is looked at.
//
// Of a muscle the coarser level has every second vertex a section, every second section, or both, or all of it. A
// level's *morph* moves its points onto the coarser action line and its vertices, along their radii, onto the coarser
// surface: sections that both have keep their shape, with vertices that go onto chords between those that stay;
// sections that go lie half way between their neighbours. A polyline with points half way along its segments has the
// same tangents, lengths and tendons as without them, so a fully morphed level draws what the coarser one draws, in any
// pose. All of it is linear in the morph: a point's binding, an end's directions, a radius.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {

struct MuscleLevel {
  std::uint32_t section_vertices = 8;          // |C|
  std::uint32_t longitudinal_subdivision = 1;  // LSS
  friend bool operator==(const MuscleLevel&, const MuscleLevel&) = default;
};

// The next coarser level of a muscle: |C| / 2 where that is even and at least 6, LSS - 1 where LSS > 1, because a belly
// without a section between its attachments is none. The same level where there is none.
MuscleLevel coarser_level(MuscleLevel level);

// What a level becomes, in the order of its own asset's arrays.
struct LevelMorph {
  std::vector<PointBinding> points;  // MuscleAsset::points; bones and slots are the same
  std::vector<EndFrame> ends;        // MuscleAsset::ends; bones are the same
  AlignedVector<float> radii;        // m; MuscleAsset::rest_radii
  // By muscle: vertex i comes to lie where, in numbers of this level, vertex i + shift of the coarser one's outline is.
  std::vector<std::uint32_t> shifts;
  // m: 95 % of the rest shape's vertices move in or out by no more. (The few that do are folds of one or two muscles.)
  float error = 0.0f;
  // m: this and all finer levels' errors. The morph is complete where that is as much as a viewer tolerates, and begins
  // at this by kMorphBand; bands of different levels do not overlap.
  float complete = 0.0f;
};
inline constexpr float kMorphBand = 1.5f;

struct MuscleLevels {
  std::vector<std::shared_ptr<const MuscleAsset>> assets;  // finest first
  std::vector<LevelMorph> morphs;  // by level; the coarsest has none
  PointBinding anchor;             // a point in the muscles' middle (its slot and muscle mean nothing)
  float radius = 0.0f;             // m: at rest no surface is further from it
};

// Builds the morphs. `finest_first` holds one asset or more, none of them null.
//
// Errors, all in one go, each by the muscle's name: assets that do not hold the same muscles in the same order, with
// the same attachments and tendons; |C| or LSS that are not the same or the next coarser; a level that a fit has
// displaced under one that none has.
Result<std::shared_ptr<const MuscleLevels>> make_muscle_levels(
    std::span<const std::shared_ptr<const MuscleAsset>> finest_first);

std::size_t heap_bytes(const MuscleLevels& levels);  // without the assets

}  // namespace fascicle::muscle
