// The musculotendon unit's equations in plain scalar code, one muscle, one section, one vertex after the other: the
// oracle that the kernels are tested against, and what a straightforward implementation costs. It is compiled with the
// same flags as the kernels, so the compiler may vectorise it where it can.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/build_frames.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle::FASCICLE_ISA::reference {

struct Vec {
  float x, y, z;
};
static inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline Vec operator*(float s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
static inline float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline Vec normalized(Vec a) { return (1.0f / __builtin_sqrtf(dot(a, a))) * a; }

static inline Vec transform(const float* m, const float* p) {
  return {p[0] * m[0] + p[1] * m[4] + p[2] * m[8] + p[3] * m[12],
          p[0] * m[1] + p[1] * m[5] + p[2] * m[9] + p[3] * m[13],
          p[0] * m[2] + p[1] * m[6] + p[2] * m[10] + p[3] * m[14]};
}

static bool check_bones(const float* bones, std::size_t count) {
  for (std::size_t i = 0; i < 16 * count; ++i) {
    if (!(__builtin_fabsf(bones[i]) <= kLargestBoneEntry)) return false;
  }
  return true;
}

static Vec transform_between(const float* m, const float* from, const float* to, float morph) {
  float mixed[4];
  for (int i = 0; i < 4; ++i) mixed[i] = from[i] + morph * (to[i] - from[i]);
  return transform(m, mixed);
}

static void place_points(const PlacePointsJob& job) {
  for (std::size_t i = 0; i < job.count; ++i) {
    const PointBinding& point = job.points[i];
    if (job.held != nullptr && job.held[point.muscle] != 0) continue;
    const float* const first_bone = job.bones + 16 * point.first_bone;
    const float* const second_bone = job.bones + 16 * point.second_bone;
    Vec at;
    if (job.targets == nullptr) {
      at = transform(first_bone, point.first);
      if (i >= job.single_count) at = at + transform(second_bone, point.second);
    } else {
      const PointBinding& target = job.targets[i];
      at = transform_between(first_bone, point.first, target.first, job.morph);
      if (i >= job.single_count) at = at + transform_between(second_bone, point.second, target.second, job.morph);
    }
    job.x[point.slot] = at.x;
    job.y[point.slot] = at.y;
    job.z[point.slot] = at.z;
  }
}

// See direction_of and square_direction_of in build_frames.hpp.
static Vec direction_of(Vec a) { return dot(a, a) > kVanishedSquared ? normalized(a) : Vec{1.0f, 0.0f, 0.0f}; }
static Vec square_direction_of(Vec a, Vec t) {
  a = a - dot(a, t) * t;
  if (dot(a, a) > kVanishedSquared) return normalized(a);
  const Vec axis = __builtin_fabsf(t.x) < 0.7f ? Vec{1.0f, 0.0f, 0.0f} : Vec{0.0f, 1.0f, 0.0f};
  return normalized(axis - dot(axis, t) * t);
}

// See `carry` in build_frames.hpp.
static Vec carry(Vec r, Vec t, Vec step, Vec next_t) {
  const float length_squared = dot(step, step), along = dot(step, t);
  Vec mirror = t;
  float k1 = 2.0f, mirror_t = 1.0f;
  if (length_squared > kShortestStepSquared && along * along > kSquareChord * length_squared) {
    mirror = step;
    k1 = 2.0f / length_squared;
    mirror_t = along;
  }
  Vec result = r - (k1 * dot(mirror, r)) * mirror;
  const Vec second = next_t - (t - (k1 * mirror_t) * mirror);
  const float second_squared = dot(second, second);
  if (second_squared > kSameTangent) result = result - (2.0f / second_squared * dot(second, result)) * second;
  return result;
}
static Vec square_up(Vec r, Vec t) { return normalized(r - dot(r, t) * t); }

static void build_lane(const BuildFramesJob& job, const LaneBlock& block, std::size_t lane, std::size_t lane_index) {
  const auto slot = [&](int k) { return block.first_slot + kLanes * static_cast<std::size_t>(k) + lane; };
  const auto point = [&](int k) { return Vec{job.x[slot(k)], job.y[slot(k)], job.z[slot(k)]}; };
  const EndFrame& origin = job.ends[2 * lane_index];
  const EndFrame& insertion = job.ends[2 * lane_index + 1];
  const int count = block.counts[lane];

  const Vec end_t = direction_of(transform(job.bones + 16 * insertion.bone, insertion.tangent));
  Vec t = direction_of(transform(job.bones + 16 * origin.bone, origin.tangent));
  Vec r = square_direction_of(transform(job.bones + 16 * origin.bone, origin.reference), t);
  Vec u = r;
  float arc = 0.0f;
  for (int k = 0; k < count; ++k) {
    const Vec before = point(k > 0 ? k - 1 : 0), here = point(k), next = point(k + 1 < count ? k + 1 : k);
    const Vec chord = next - before;
    Vec next_t = dot(chord, chord) > kShortestStepSquared ? normalized(chord) : t;
    if (k == 0 && origin.fixed != 0) next_t = t;
    if (k + 1 == count && insertion.fixed != 0) next_t = end_t;
    r = carry(r, t, here - before, next_t);
    t = next_t;
    u = square_up(r, t);
    const Vec v = cross(t, u);
    job.ux[slot(k)] = u.x;
    job.uy[slot(k)] = u.y;
    job.uz[slot(k)] = u.z;
    job.vx[slot(k)] = v.x;
    job.vy[slot(k)] = v.y;
    job.vz[slot(k)] = v.z;
    job.arc[slot(k)] = arc;
    arc += __builtin_sqrtf(dot(next - here, next - here));
  }

  const Vec end_r = square_direction_of(transform(job.bones + 16 * insertion.bone, insertion.reference), end_t);
  const Vec wanted = square_up(carry(end_r, end_t, Vec{0.0f, 0.0f, 0.0f}, t), t);
  float twist = __builtin_atan2f(dot(cross(t, u), wanted), dot(u, wanted));
  const float last = job.restart_twist ? 0.0f : job.twist[lane_index];
  twist += 6.2831853071795865f * __builtin_rintf((last - twist) / 6.2831853071795865f);
  job.twist[lane_index] = twist;

  const float rate = arc > 1.0e-5f ? twist / arc : 0.0f;
  for (int k = 0; k < count; ++k) {
    const std::size_t s = slot(k);
    const float sine = __builtin_sinf(rate * job.arc[s]), cosine = __builtin_cosf(rate * job.arc[s]);
    const Vec u_k{job.ux[s], job.uy[s], job.uz[s]}, v_k{job.vx[s], job.vy[s], job.vz[s]};
    const Vec new_u = cosine * u_k + sine * v_k, new_v = cosine * v_k - sine * u_k;
    job.ux[s] = new_u.x;
    job.uy[s] = new_u.y;
    job.uz[s] = new_u.z;
    job.vx[s] = new_v.x;
    job.vy[s] = new_v.y;
    job.vz[s] = new_v.z;
  }
}

static void build_frames(const BuildFramesJob& job) {
  for (std::size_t block = 0; block < job.block_count; ++block) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t lane_index = block * kLanes + lane;
      if (job.blocks[block].counts[lane] == 0 || (job.held != nullptr && job.held[lane_index] != 0)) continue;
      build_lane(job, job.blocks[block], lane, lane_index);
    }
  }
}

static void find_tendons(const FindTendonsJob& job) {
  for (std::size_t b = 0; b < job.block_count; ++b) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const LaneBlock& block = job.blocks[b];
      const int count = block.counts[lane];
      if (count < 2) continue;
      const std::size_t lane_index = b * kLanes + lane;
      const auto arc = [&](int k) { return job.arc[block.first_slot + kLanes * static_cast<std::size_t>(k) + lane]; };
      float insertion = arc(count - 1) - job.insertion_lengths[lane_index];
      if (insertion < 0.0f) insertion = 0.0f;
      float origin = job.origin_lengths[lane_index];
      if (insertion < origin) origin = insertion;
      const float borders[2] = {origin, insertion};
      for (int end = 0; end < 2; ++end) {
        int segment = 0;
        while (segment + 2 < count && arc(segment + 1) <= borders[end]) ++segment;
        const float length = arc(segment + 1) - arc(segment);
        float fraction = length > 0.0f ? (borders[end] - arc(segment)) / length : 0.0f;
        fraction = fraction < 0.0f ? 0.0f : fraction > 1.0f ? 1.0f : fraction;
        job.segment[end][lane_index] = segment;
        job.fraction[end][lane_index] = fraction;
        job.border_arc[end][lane_index] = borders[end];
      }
    }
  }
}

struct Section {
  Vec a, u, v;
  const float* radii;
};

static inline Section section(const SectionsView& view, const SectionLayout& layout, std::uint32_t k) {
  const std::size_t s = layout.first_slot + std::size_t{kLanes} * k;
  return {{view.x[s], view.y[s], view.z[s]},
          {view.ux[s], view.uy[s], view.uz[s]},
          {view.vx[s], view.vy[s], view.vz[s]},
          view.radii + layout.first_radius + std::size_t{layout.radius_stride} * k};
}

static inline Vec radial(const Section& s, const Circle& circle, std::uint32_t i) {
  return circle.cosines[i] * s.u + circle.sines[i] * s.v;
}
static inline Vec vertex(const Section& s, const Circle& circle, std::uint32_t i) {
  return s.a + s.radii[i] * radial(s, circle, i);
}

static inline std::uint32_t pack(Vec n) {
  const auto bits = [](float value) { return static_cast<std::uint32_t>(__builtin_lrintf(511.0f * value)) & 1023u; };
  return bits(n.x) | bits(n.y) << 10 | bits(n.z) << 20;
}

static inline void write_vertex(Vec at, Vec normal, float* to) {
  to[0] = at.x;
  to[1] = at.y;
  to[2] = at.z;
  const std::uint32_t packed = pack(normal);
  __builtin_memcpy(to + 3, &packed, sizeof(packed));
}

static inline Vec surface_normal(Vec e, Vec d, Vec otherwise) {
  const Vec n = cross(e, d);
  return dot(n, n) < 1.0e-34f ? normalized(otherwise) : normalized(n);
}

// Squared length below which the mean of two unit normals has no direction.
inline constexpr float kOppositeNormals = 4.0e-6f;

// First all positions, then the normals from them.
static void write_muscle(const SectionsView& view, const SectionLayout& layout, float* to) {
  const int count = static_cast<int>(layout.section_vertices), last = static_cast<int>(layout.section_count) - 1;
  const Circle& circle = view.circles[layout.circle];
  int segment[2];  // beyond the last section where no tendon is drawn
  for (int end = 0; end < 2; ++end) {
    segment[end] = layout.tendon_drawn[end] ? view.segment[end][layout.lane_index] : last + 1;
  }
  const auto row_of = [&](int k) { return k + (segment[0] < k ? 1 : 0) + (segment[1] < k ? 1 : 0); };
  const auto tendon_row = [&](int end) {
    return row_of(segment[end]) + 1 + (end == 1 && segment[0] == segment[1] ? 1 : 0);
  };
  const auto vertex_at = [&](int row, int i) { return to + kFloatsPerVertex * (row * count + i); };
  const auto position = [&](int row, int i) {
    const float* v = vertex_at(row, i);
    return Vec{v[0], v[1], v[2]};
  };
  const auto write_position = [&](int row, int i, Vec at) {
    float* v = vertex_at(row, i);
    v[0] = at.x;
    v[1] = at.y;
    v[2] = at.z;
  };
  const auto write_normal = [&](int row, int i, Vec normal) {
    const std::uint32_t packed = pack(normal);
    __builtin_memcpy(vertex_at(row, i) + 3, &packed, sizeof(packed));
  };

  for (int k = 0; k <= last; ++k) {
    const Section here = section(view, layout, static_cast<std::uint32_t>(k));
    for (int i = 0; i < count; ++i) write_position(row_of(k), i, vertex(here, circle, static_cast<std::uint32_t>(i)));
  }
  for (int end = 0; end < 2; ++end) {
    if (segment[end] > last) continue;
    const float s = view.fraction[end][layout.lane_index];
    for (int i = 0; i < count; ++i) {
      const Vec a = position(row_of(segment[end]), i);
      write_position(tendon_row(end), i, a + s * (position(row_of(segment[end] + 1), i) - a));
    }
  }

  const auto around = [&](int row, int i) {
    return position(row, i + 1 < count ? i + 1 : 0) - position(row, i > 0 ? i - 1 : count - 1);
  };
  const auto along = [&](int k, int i) {
    return position(row_of(k < last ? k + 1 : k), i) - position(row_of(k > 0 ? k - 1 : k), i);
  };
  Vec beside[2][2][kMaxSectionVertices];  // normals of the sections before and after each tendon section
  for (int k = 0; k <= last; ++k) {
    const Section here = section(view, layout, static_cast<std::uint32_t>(k));
    for (int i = 0; i < count; ++i) {
      const Vec otherwise = radial(here, circle, static_cast<std::uint32_t>(i));
      const Vec normal = surface_normal(around(row_of(k), i), along(k, i), otherwise);
      write_normal(row_of(k), i, normal);
      for (int end = 0; end < 2; ++end) {
        if (segment[end] == k) beside[end][0][i] = normal;
        if (segment[end] + 1 == k) beside[end][1][i] = normal;
      }
    }
  }
  for (int end = 0; end < 2; ++end) {
    if (segment[end] > last) continue;
    const float s = view.fraction[end][layout.lane_index];
    for (int i = 0; i < count; ++i) {
      const Vec a = beside[end][0][i], between = a + s * (beside[end][1][i] - a);
      write_normal(tendon_row(end), i, normalized(dot(between, between) < kOppositeNormals ? a : between));
    }
  }
  const Section first = section(view, layout, 0), end = section(view, layout, static_cast<std::uint32_t>(last));
  float* const centres = to + kFloatsPerVertex * layout.row_count * layout.section_vertices;
  write_vertex(first.a, -1.0f * cross(first.u, first.v), centres);
  write_vertex(end.a, cross(end.u, end.v), centres + kFloatsPerVertex);
}

static void write_surfaces(const WriteSurfacesJob& job) {
  const SectionsView& view = job.sections;
  for (std::uint32_t muscle = 0; muscle < view.muscle_count; ++muscle) {
    const SectionLayout& layout = view.layouts[muscle];
    float* to = job.vertices + kFloatsPerVertex * std::size_t{layout.first_vertex};
    if (view.attached == nullptr || view.attached[muscle] != 0) {
      write_muscle(view, layout, to);
    } else {
      const Section first = section(view, layout, 0);
      for (std::uint32_t i = 0; i < layout.vertex_count; ++i) {
        write_vertex(first.a, -1.0f * cross(first.u, first.v), to + kFloatsPerVertex * i);
      }
    }
  }
}

// Six times the signed volume of the tetrahedron.
static inline float six_volumes(Vec x, Vec y, Vec z, Vec w) { return dot(w - z, cross(x - z, y - z)); }

// The method's 3 |C| tetrahedra a segment, taken one by one, with their signs.
static void measure_volume(const MeasureVolumeJob& job) {
  const SectionsView& view = job.sections;
  for (std::uint32_t muscle = 0; muscle < view.muscle_count; ++muscle) {
    job.volumes[muscle] = 0.0f;
    if (view.attached != nullptr && view.attached[muscle] == 0) continue;
    const SectionLayout& layout = view.layouts[muscle];
    const Circle& circle = view.circles[layout.circle];
    const int first = view.segment[0][layout.lane_index], last = view.segment[1][layout.lane_index];
    const float start = view.fraction[0][layout.lane_index], end = view.fraction[1][layout.lane_index];
    float sum = 0.0f;
    for (int k = first; k <= last; ++k) {
      const Section here = section(view, layout, static_cast<std::uint32_t>(k));
      const Section next = section(view, layout, static_cast<std::uint32_t>(k + 1));
      const float s0 = k == first ? start : 0.0f, s1 = k == last ? end : 1.0f;
      const auto at = [&](std::uint32_t i, float s) {
        const Vec c = vertex(here, circle, i);
        return c + s * (vertex(next, circle, i) - c);
      };
      const Vec a = here.a + s0 * (next.a - here.a), b = here.a + s1 * (next.a - here.a);
      for (std::uint32_t i = 0; i < layout.section_vertices; ++i) {
        const std::uint32_t j = i + 1 < layout.section_vertices ? i + 1 : 0;
        const Vec p = at(i, s0), q = at(j, s0), p_next = at(i, s1), q_next = at(j, s1);
        sum += six_volumes(b, p_next, a, q_next) + six_volumes(p, q, a, q_next) + six_volumes(p, q_next, a, p_next);
      }
    }
    job.volumes[muscle] = sum > 0.0f ? sum / 6.0f : 0.0f;
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA::reference
