#include "tools/walker/muscle_sections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

namespace fascicle::walker {
namespace {

constexpr int kRelaxSteps = 160;
constexpr float kSunkEnd = 0.004f;     // m: a mesh starts and ends this deep in its bone, as attachments have an area
constexpr float kSidewaysDrag = 0.6f;  // flat bellies rather stack than slip aside
constexpr float kEndShare = 0.10f;     // of the length at each end, where the curve is held to the attachment

float smooth_step(float t) {
  t = std::clamp(t, 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// How much of the belly is present at fraction s: 0 in the tendons, 1 at the peak.
float belly_share(const BellyShape& shape, float s) {
  if (s <= shape.begin || s >= shape.end) return 0.0f;
  const float t =
      s < shape.peak ? (s - shape.begin) / (shape.peak - shape.begin) : (shape.end - s) / (shape.end - shape.peak);
  return std::pow(std::sin(0.5f * glm::pi<float>() * std::clamp(t, 0.0f, 1.0f)), 1.15f);
}

float mobility(float s) { return smooth_step(s / kEndShare) * smooth_step((1.0f - s) / kEndShare); }

std::vector<glm::vec3> resample(const std::vector<glm::vec3>& line, std::size_t count) {
  std::vector<float> at{0.0f};
  for (std::size_t i = 1; i < line.size(); ++i) at.push_back(at.back() + glm::distance(line[i - 1], line[i]));
  std::vector<glm::vec3> points;
  std::size_t k = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float target = at.back() * static_cast<float>(i) / static_cast<float>(count - 1);
    while (k + 2 < line.size() && at[k + 1] < target) ++k;
    const float t = (target - at[k]) / std::max(at[k + 1] - at[k], 1e-9f);
    points.push_back(glm::mix(line[k], line[k + 1], std::clamp(t, 0.0f, 1.0f)));
  }
  return points;
}

void smooth(std::vector<glm::vec3>& points, int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    glm::vec3 previous = points.front();
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const glm::vec3 here = points[i];
      points[i] = 0.5f * here + 0.25f * (previous + points[i + 1]);
      previous = here;
    }
  }
}

glm::vec3 shift_at(const BellyShape& shape, float s) {
  constexpr float kTendon = 0.85f;  // where tendon_shift holds
  glm::vec3 shift;
  if (s < 0.5f)
    shift = glm::mix(shape.origin_shift, shape.middle_shift, smooth_step(2.0f * s));
  else if (s < kTendon)
    shift = glm::mix(shape.middle_shift, shape.tendon_shift, smooth_step((s - 0.5f) / (kTendon - 0.5f)));
  else
    shift = glm::mix(shape.tendon_shift, shape.insertion_shift, smooth_step((s - kTendon) / (1.0f - kTendon)));
  return 0.001f * from_opensim(shift);
}

// Frames and sizes for the curve through the present centres; the belly's area is solved for the volume.
void shape_sections(Belly& belly) {
  const BellyShape& shape = belly.muscle->belly;
  const std::size_t n = belly.sections.size();
  belly.length = 0.0f;
  for (std::size_t i = 1; i < n; ++i)
    belly.length += glm::distance(belly.sections[i - 1].centre, belly.sections[i].centre);
  const float step = belly.length / static_cast<float>(n - 1);

  const float a0 = shape.origin_width * shape.origin_thickness, a1 = shape.insertion_width * shape.insertion_thickness;
  const auto share_of = [&](std::size_t i) {
    return belly_share(shape, static_cast<float>(i) / static_cast<float>(n - 1));
  };
  double ends_volume = 0.0, belly_volume = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const float s = static_cast<float>(i) / static_cast<float>(n - 1);
    ends_volume += share_of(i) > 0.0f ? glm::pi<float>() * 1e-6f * glm::mix(a0, a1, s) * step : 0.0f;
    belly_volume += glm::pi<float>() * share_of(i) * step;
  }
  const float peak_area =
      std::max(0.0f, static_cast<float>((belly.muscle->volume() - 0.5 * ends_volume) / belly_volume));

  for (std::size_t i = 0; i < n; ++i) {
    Section& section = belly.sections[i];
    const float s = static_cast<float>(i) / static_cast<float>(n - 1);
    const std::size_t before = i < 2 ? 0 : i - 2, after = std::min(i + 2, n - 1);
    section.tangent = glm::normalize(belly.sections[after].centre - belly.sections[before].centre);
    const glm::vec3 out =
        from_opensim(glm::mix(glm::normalize(shape.outward_origin), glm::normalize(shape.outward_insertion), s));
    section.v = glm::normalize(out - glm::dot(out, section.tangent) * section.tangent);
    section.u = glm::cross(section.v, section.tangent);
    const float share = share_of(i);
    const float end_w = glm::mix(shape.origin_width, shape.insertion_width, smooth_step(s)) * 0.001f;
    const float end_h = glm::mix(shape.origin_thickness, shape.insertion_thickness, smooth_step(s)) * 0.001f;
    // A tendon between its ends is rounder and thinner than where it fans out on the bone.
    const float near_end = std::max(1.0f - s / 0.12f, 1.0f - (1.0f - s) / 0.12f);
    const float waist = glm::mix(0.52f, 1.0f, smooth_step(near_end));
    const float tendon_w = std::max(end_w * waist, 0.0015f), tendon_h = end_h * glm::mix(1.0f, waist, 0.3f);
    const float area = peak_area * share;  // divided by pi already: w h
    const float belly_h = std::sqrt(area / shape.aspect);
    const float belly_w = area > 0.0f ? area / belly_h : 0.0f;
    section.w = std::hypot(tendon_w, belly_w);
    section.h = std::hypot(tendon_h, belly_h);
    section.bend = shape.wrap * (0.25f + 0.75f * share);
    section.skew = shape.skew * share;
  }
}

float support(const Section& section, const glm::vec3& direction) {
  return std::hypot(section.w * glm::dot(direction, section.u), section.h * glm::dot(direction, section.v));
}

// Moves two bellies apart where their ellipses would meet.
void separate(Belly& a, Belly& b, std::vector<glm::vec3>& push_a, std::vector<glm::vec3>& push_b) {
  const std::size_t na = a.sections.size(), nb = b.sections.size();
  for (std::size_t i = 0; i < na; ++i) {
    const Section& sa = a.sections[i];
    for (std::size_t j = 0; j < nb; ++j) {
      const Section& sb = b.sections[j];
      glm::vec3 apart = sa.centre - sb.centre;
      const float reach = std::max(sa.w, sa.h) + std::max(sb.w, sb.h);
      const float distance = glm::length(apart);
      if (distance > reach) continue;
      apart = distance > 1e-5f ? apart / distance : sa.v;
      const float wanted = 0.85f * (support(sa, apart) + support(sb, apart));
      if (distance >= wanted) continue;
      const float share = sb.h / (sa.h + sb.h);  // the thinner one gives way
      const glm::vec3 move = (wanted - distance) * apart;
      push_a[i] += share * move;
      push_b[j] -= (1.0f - share) * move;
    }
  }
}

void relax(std::vector<Belly>& bellies, const std::vector<BoneShape>& shapes) {
  std::vector<std::vector<glm::vec3>> home(bellies.size()), push(bellies.size());
  for (std::size_t m = 0; m < bellies.size(); ++m)
    for (const Section& section : bellies[m].sections) home[m].push_back(section.centre);
  for (int step = 0; step < kRelaxSteps; ++step) {
    for (std::size_t m = 0; m < bellies.size(); ++m) push[m].assign(bellies[m].sections.size(), glm::vec3(0.0f));
    for (std::size_t m = 0; m < bellies.size(); ++m)
      for (std::size_t other = m + 1; other < bellies.size(); ++other)
        separate(bellies[m], bellies[other], push[m], push[other]);
    for (std::size_t m = 0; m < bellies.size(); ++m) {
      Belly& belly = bellies[m];
      const std::size_t n = belly.sections.size();
      std::vector<glm::vec3> centres(n);
      for (std::size_t i = 0; i < n; ++i) {
        Section& section = belly.sections[i];
        const float s = static_cast<float>(i) / static_cast<float>(n - 1);
        glm::vec3 move = glm::clamp(push[m][i] * 0.12f, glm::vec3(-0.002f), glm::vec3(0.002f));
        move -= kSidewaysDrag * glm::dot(move, section.u) * section.u;
        move += 0.02f * (home[m][i] - section.centre);
        const float clearance = belly.muscle->belly.lift * section.h + 0.0008f;
        const float distance = rest_distance(shapes, section.centre);
        if (distance < clearance) move += 0.5f * (clearance - distance) * rest_outward(shapes, section.centre);
        move -= glm::dot(move, section.tangent) * section.tangent;
        centres[i] = section.centre + mobility(s) * move;
      }
      smooth(centres, 1);
      for (std::size_t i = 0; i < n; ++i) belly.sections[i].centre = centres[i];
      shape_sections(belly);
    }
  }
}

}  // namespace

glm::vec3 Section::point(const glm::vec2& e) const {
  const float radius = 2.0f * w / std::max(bend, 1e-3f);
  const float angle = e.x * w / radius;
  const float y = e.y * h * (1.0f + skew * e.x);
  return centre + u * ((radius + y) * std::sin(angle)) + v * ((radius + y) * std::cos(angle) - radius);
}

glm::vec2 Section::coordinates(const glm::vec3& p) const {
  const float radius = 2.0f * w / std::max(bend, 1e-3f);
  const float a = glm::dot(p - centre, u), b = glm::dot(p - centre, v) + radius;
  const float x = std::atan2(a, b) * radius / w;
  const float thickness = h * std::max(1.0f + skew * std::clamp(x, -1.0f, 1.0f), 0.2f);
  return {x, (std::hypot(a, b) - radius) / thickness};
}

float Belly::normalised_radius(const glm::vec3& p) const {
  std::size_t nearest = 0;
  float best = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const glm::vec3 d = p - sections[i].centre;
    const float squared = glm::dot(d, d);
    if (squared < best) {
      best = squared;
      nearest = i;
    }
  }
  const Section& at = sections[nearest];
  if (best > 16.0f * at.w * at.w) return 4.0f;
  const float along = glm::dot(p - at.centre, at.tangent);
  const std::size_t next =
      along >= 0.0f ? std::min(nearest + 1, sections.size() - 1) : (nearest == 0 ? 0 : nearest - 1);
  if (next == nearest) {
    const glm::vec2 e = at.coordinates(p - along * at.tangent);
    return std::hypot(glm::length(e), along / at.h);
  }
  const Section& to = sections[next];
  const float t = std::clamp(std::abs(along) / std::max(glm::distance(at.centre, to.centre), 1e-9f), 0.0f, 1.0f);
  return glm::mix(glm::length(at.coordinates(p)), glm::length(to.coordinates(p)), t);
}

std::vector<Belly> arrange_bellies(const std::vector<MuscleSpec>& muscles, const std::vector<BoneShape>& shapes,
                                   const std::vector<std::size_t>& stations) {
  std::vector<Belly> bellies(muscles.size());
  for (std::size_t m = 0; m < muscles.size(); ++m) {
    Belly& belly = bellies[m];
    belly.muscle = &muscles[m];
    std::vector<glm::vec3> line = resample(rest_path(muscles[m]), stations[m]);
    smooth(line, static_cast<int>(stations[m]) / 3);
    line.insert(line.begin(), line[0] + kSunkEnd * glm::normalize(line[0] - line[1]));
    line.push_back(line.back() + kSunkEnd * glm::normalize(line.back() - line[line.size() - 2]));
    for (std::size_t i = 0; i < line.size(); ++i)
      line[i] += shift_at(muscles[m].belly, static_cast<float>(i) / static_cast<float>(line.size() - 1));
    belly.sections.resize(stations[m]);
    line = resample(line, stations[m]);
    for (std::size_t i = 0; i < line.size(); ++i) belly.sections[i].centre = line[i];
    shape_sections(belly);
  }
  relax(bellies, shapes);
  return bellies;
}

void grow_belly(Belly& belly, float factor) {
  const std::size_t n = belly.sections.size();
  for (std::size_t i = 0; i < n; ++i) {
    const float share = belly_share(belly.muscle->belly, static_cast<float>(i) / static_cast<float>(n - 1));
    const float scale = glm::mix(1.0f, std::sqrt(factor), std::min(1.0f, 2.0f * share));
    belly.sections[i].w *= scale;
    belly.sections[i].h *= scale;
  }
}

}  // namespace fascicle::walker
