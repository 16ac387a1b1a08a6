#include "modules/muscle/kernels/surface/surface_reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace fascicle::muscle {
namespace {

glm::vec3 place(const SurfacePoint& p) { return {p.x, p.y, p.z}; }

void add(SurfacePoint& p, const glm::vec3& d) {
  p.x += d.x;
  p.y += d.y;
  p.z += d.z;
}

void project_edge(SurfacePoint& p1, SurfacePoint& p2, float length, float compliance) {
  const float masses = p1.inverse_mass + p2.inverse_mass;
  const glm::vec3 e = place(p2) - place(p1);
  const float now = std::sqrt(glm::dot(e, e));
  if (!(masses > 0.0f) || !(now > kShortestEdge)) return;
  const float lambda = -(now - length) / (masses + compliance);
  const glm::vec3 step = e * (lambda / now);
  add(p1, -p1.inverse_mass * step);
  add(p2, p2.inverse_mass * step);
}

// The angle and its parts that the gradients need.
struct Fold {
  glm::vec3 e{0.0f}, normal_1{0.0f}, normal_2{0.0f};
  float e2 = 0.0f, n1 = 0.0f, n2 = 0.0f;  // squared lengths
  float angle = 0.0f;
  bool sound = false;
};

Fold fold_of(const SurfacePoint& p1, const SurfacePoint& p2, const SurfacePoint& p3, const SurfacePoint& p4) {
  Fold fold;
  fold.e = place(p2) - place(p1);
  fold.normal_1 = glm::cross(fold.e, place(p3) - place(p1));
  fold.normal_2 = glm::cross(place(p4) - place(p1), fold.e);
  fold.e2 = glm::dot(fold.e, fold.e);
  fold.n1 = glm::dot(fold.normal_1, fold.normal_1);
  fold.n2 = glm::dot(fold.normal_2, fold.normal_2);
  fold.sound = fold.e2 > kShortestEdge * kShortestEdge && fold.n1 > kSmallestArea2 && fold.n2 > kSmallestArea2;
  if (!fold.sound) return fold;
  const float sine = glm::dot(glm::cross(fold.normal_1, fold.normal_2), fold.e) / std::sqrt(fold.e2);
  fold.angle = std::atan2(sine, glm::dot(fold.normal_1, fold.normal_2));
  return fold;
}

float wrap(float angle) {
  constexpr float kPi = std::numbers::pi_v<float>;
  if (angle > kPi) return angle - 2.0f * kPi;
  if (angle < -kPi) return angle + 2.0f * kPi;
  return angle;
}

void project_angle(SurfacePoint& p1, SurfacePoint& p2, SurfacePoint& p3, SurfacePoint& p4, float rest,
                   float compliance) {
  const Fold fold = fold_of(p1, p2, p3, p4);
  if (!fold.sound) return;
  const float c = wrap(fold.angle - rest);
  // Gradients of theta (4.1). With A = N_1 / |N_1|^2 and B = N_2 / |N_2|^2, moving p_3 along N_1 turns its triangle back.
  const float length = std::sqrt(fold.e2);
  const glm::vec3 a = fold.normal_1 / fold.n1, b = fold.normal_2 / fold.n2;
  const glm::vec3 g3 = -length * a, g4 = -length * b;
  const float along_3 = glm::dot(place(p3) - place(p1), fold.e), along_4 = glm::dot(place(p4) - place(p1), fold.e);
  const glm::vec3 g2 = (along_3 * a + along_4 * b) / length;
  const glm::vec3 g1 = -(g2 + g3 + g4);
  const float sum = p1.inverse_mass * glm::dot(g1, g1) + p2.inverse_mass * glm::dot(g2, g2) +
                    p3.inverse_mass * glm::dot(g3, g3) + p4.inverse_mass * glm::dot(g4, g4);
  if (!(sum > 0.0f)) return;
  const float lambda = -c / (sum + compliance);
  add(p1, p1.inverse_mass * lambda * g1);
  add(p2, p2.inverse_mass * lambda * g2);
  add(p3, p3.inverse_mass * lambda * g3);
  add(p4, p4.inverse_mass * lambda * g4);
}

void project_hinges(const HingeJob& job) {
  for (const HingePack& pack : job.packs) {
    for (std::size_t lane = 0; lane < kHingeLanes; ++lane) {
      std::array<SurfacePoint*, 4> p{};
      for (std::size_t i = 0; i < 4; ++i) p[i] = &job.points[static_cast<std::size_t>(pack.vertex[i][lane])];
      project_edge(*p[0], *p[1], pack.length[lane], pack.stretch_compliance[lane] * job.inverse_h2);
      project_angle(*p[0], *p[1], *p[2], *p[3], pack.angle[lane], pack.bend_compliance[lane] * job.inverse_h2);
    }
  }
}

double volume_of(const VolumeJob& job, bool with_gradient) {
  if (with_gradient) std::fill_n(job.gradient.begin(), job.vertex_count, SurfacePoint{});
  const glm::vec3 origin = place(job.points[0]);
  double volume = 0.0;
  for (std::size_t t = 0; t + 2 < job.triangles.size(); t += 3) {
    const std::uint32_t i = job.triangles[t], j = job.triangles[t + 1], k = job.triangles[t + 2];
    const glm::vec3 a = place(job.points[i]) - origin, b = place(job.points[j]) - origin,
                    c = place(job.points[k]) - origin;
    const glm::vec3 bc = glm::cross(b, c);
    volume += static_cast<double>(glm::dot(a, bc));
    if (!with_gradient) continue;
    add(job.gradient[i], bc);
    add(job.gradient[j], glm::cross(c, a));
    add(job.gradient[k], glm::cross(a, b));
  }
  return volume;
}

double measure_volume(const VolumeJob& job) { return volume_of(job, false); }

double project_volume(const VolumeJob& job) {
  const double volume = volume_of(job, true);
  double sum = 0.0;
  for (std::size_t v = 0; v < job.vertex_count; ++v) {
    const glm::vec3 g = place(job.gradient[v]);
    sum += static_cast<double>(job.points[v].inverse_mass * glm::dot(g, g));
  }
  if (!(sum > 0.0)) return volume;
  const float lambda = static_cast<float>(-(volume - job.rest) / (sum + static_cast<double>(job.compliance)));
  for (std::size_t v = 0; v < job.vertex_count; ++v) {
    add(job.points[v], job.points[v].inverse_mass * lambda * place(job.gradient[v]));
  }
  return volume;
}

// How far its carriers take a point.
glm::vec3 carried(std::span<const CarryWeights> carry, std::span<const float> moved, std::size_t v,
                  const SurfacePoint& p) {
  glm::vec3 sum{0.0f};
  if (carry.empty()) return sum;
  for (std::size_t i = 0; i < 4; ++i) {
    const float* row = moved.data() + 12 * static_cast<std::size_t>(carry[v].carrier[i]);
    sum += carry[v].weight[i] * glm::vec3(row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3],
                                          row[4] * p.x + row[5] * p.y + row[6] * p.z + row[7],
                                          row[8] * p.x + row[9] * p.y + row[10] * p.z + row[11]);
  }
  return sum;
}

void carry(const CarryJob& job) {
  for (std::size_t v = 0; v < job.vertex_count; ++v) {
    job.out[v] = job.rest[v];
    add(job.out[v], carried(job.carry, job.moved, v, job.rest[v]));
  }
}

void predict(const PredictJob& job) {
  for (std::size_t v = 0; v < job.vertex_count; ++v) {
    SurfacePoint& p = job.points[v];
    if (!(p.inverse_mass > 0.0f)) continue;
    add(p, carried(job.carry, job.moved, v, p));
    job.before[v] = p;
    add(p, job.h * job.keep * place(job.velocity[v]));
    if (job.pull > 0.0f) add(p, job.pull * (place(job.anchors[v]) - place(p)));
  }
}

void take_velocities(const PredictJob& job) {
  for (std::size_t v = 0; v < job.vertex_count; ++v) {
    const SurfacePoint &p = job.points[v], &q = job.before[v];
    const glm::vec3 moved = p.inverse_mass > 0.0f ? (place(p) - place(q)) / job.h : glm::vec3(0.0f);
    job.velocity[v] = {moved.x, moved.y, moved.z, 0.0f};
  }
}

void measure_hinges(std::span<const HingePack> packs, std::span<const SurfacePoint> points, std::span<float> lengths,
                    std::span<float> angles) {
  for (std::size_t i = 0; i < packs.size() * kHingeLanes; ++i) {
    const HingePack& pack = packs[i / kHingeLanes];
    std::array<SurfacePoint, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = points[static_cast<std::size_t>(pack.vertex[k][i % kHingeLanes])];
    const glm::vec3 e = place(p[1]) - place(p[0]);
    lengths[i] = std::sqrt(glm::dot(e, e));
    angles[i] = fold_of(p[0], p[1], p[2], p[3]).angle;
  }
}

void fade_differences(const ViscosityJob& job) {
  for (const HingePack& pack : job.packs) {
    for (std::size_t lane = 0; lane < kHingeLanes; ++lane) {
      const auto i = static_cast<std::size_t>(pack.vertex[0][lane]), j = static_cast<std::size_t>(pack.vertex[1][lane]);
      const float w1 = job.points[i].inverse_mass, w2 = job.points[j].inverse_mass;
      if (!(w1 + w2 > 0.0f)) continue;
      const glm::vec3 push = job.share / (w1 + w2) * (place(job.velocity[j]) - place(job.velocity[i]));
      add(job.velocity[i], w1 * push);
      add(job.velocity[j], -w2 * push);
    }
  }
}

}  // namespace

const SurfaceKernels& surface_reference_kernels() {
  static const SurfaceKernels kKernels{.project_hinges = project_hinges,
                                       .project_volume = project_volume,
                                       .measure_volume = measure_volume,
                                       .carry = carry,
                                       .predict = predict,
                                       .take_velocities = take_velocities,
                                       .measure_hinges = measure_hinges,
                                       .fade_differences = fade_differences};
  return kKernels;
}

}  // namespace fascicle::muscle
