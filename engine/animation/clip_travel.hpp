// Walking on the spot: takes the way that a clip's root covers out of a pose, and leaves its sway in.
#pragma once

#include <cstdint>
#include <span>

#include "engine/animation/clip.hpp"
#include "engine/animation/skeleton.hpp"

namespace fascicle {

// The translation channel of the bone that carries the character through the clip: the topmost bone, the first of
// several, whose translation keys differ from each other. Null where no bone's do.
const ClipChannel* find_travelling_root(const Clip& clip, const Skeleton& skeleton);

// Takes the travel out of `pose`, as `sample_clip` wrote it for `time` (s, on the clip's own axis). The travel is the
// root's linear drift from its first key to its last, along x and z of the character's space; the root stays over the
// place of its first key but for the periodic part of its motion, and height is left alone. The bones above the root
// are taken to stand still through the clip. A clip without drift leaves the pose as it is, bit for bit.
void hold_in_place(const Clip& clip, const Skeleton& skeleton, float time, std::span<Trs> pose);

}  // namespace fascicle
