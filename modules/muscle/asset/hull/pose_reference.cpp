#include "modules/muscle/asset/hull/pose_reference.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "modules/muscle/asset/hull/direction_parts.hpp"
#include "modules/muscle/asset/hull/shape_energy.hpp"
#include "modules/muscle/kernels/hull/line_place.hpp"

namespace fascicle::muscle {
namespace {

using Matrix = Eigen::MatrixXd;

constexpr double kAttachmentWeight = 1.0e6;  // the hull's vertices are held exactly at its end
constexpr std::uint32_t kMostIterations = 500;

Eigen::Vector3d to_eigen(const glm::vec3& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

Eigen::Vector3d apply(const glm::mat4& m, const Eigen::Vector3d& p) {
  const glm::dvec4 q = glm::dmat4(m) * glm::dvec4(p.x(), p.y(), p.z(), 1.0);
  return {q.x, q.y, q.z};
}

double volume_of(std::span<const std::uint32_t> triangles, const Places& places, Places* gradient) {
  if (gradient != nullptr) gradient->setZero(places.rows(), 3);
  const Eigen::Vector3d origin = places.row(0).transpose();
  double six = 0.0;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const auto at = [&](std::size_t k) { return Eigen::Vector3d(places.row(triangles[t + k]).transpose() - origin); };
    const Eigen::Vector3d a = at(0), b = at(1), c = at(2);
    six += a.dot(b.cross(c));
    if (gradient == nullptr) continue;
    gradient->row(triangles[t]) += b.cross(c).transpose() / 6.0;
    gradient->row(triangles[t + 1]) += c.cross(a).transpose() / 6.0;
    gradient->row(triangles[t + 2]) += a.cross(b).transpose() / 6.0;
  }
  return six / 6.0;
}

}  // namespace

struct PoseReference::Parts {
  const SurfaceAsset& surface;
  const HullAsset& hull;
  ShapeEnergy energy;
  SparseMatrix matrix, loads;
  Eigen::SimplicialLLT<SparseMatrix> solver;
  // The main direction adds a few dense rows D: (A + D'D)^-1 by Woodbury.
  Matrix rows, solved, small;

  Parts(const SurfaceAsset& surface_asset, const HullAsset& hull_asset)
      : surface(surface_asset), hull(hull_asset),
        energy(build_shape_energy(surface_asset, static_cast<double>(hull_asset.settings.bending))) {
    std::vector<std::uint32_t> own(surface.vertex_count);
    for (std::uint32_t v = 0; v < surface.vertex_count; ++v) own[v] = v;
    loads = energy.loads(own, surface.vertex_count);
    matrix = energy.matrix();
    SparseMatrix held = matrix;
    for (const AttachedVertex& attached : surface.attached) {
      held.coeffRef(attached.vertex, attached.vertex) += kAttachmentWeight;
    }
    solver.compute(held);
    const DirectionParts parts = find_direction_parts(surface, hull.line);
    const double weight = static_cast<double>(hull.settings.direction) * static_cast<double>(parts.along.size());
    rows = std::sqrt(weight) * Matrix(parts.differences);
    solved = solver.solve(rows.transpose());
    small = (Matrix::Identity(rows.rows(), rows.rows()) + rows * solved).inverse();
  }

  Places solve(const Places& right) const {
    const Places x = solver.solve(right);
    if (rows.rows() == 0) return x;
    return x - solved * (small * (rows * x));
  }

  // R by vertex, as rows of B' V want them: row 3 v + k is column k.
  Places rotations_of(const Places& places) const {
    const Places shape = loads.transpose() * places;
    Places columns(shape.rows(), 3);
    for (Eigen::Index v = 0; v < places.rows(); ++v) {
      const Eigen::Matrix3d s = shape.middleRows<3>(3 * v).transpose();
      const Eigen::JacobiSVD<Eigen::Matrix3d> svd(s, Eigen::ComputeFullU | Eigen::ComputeFullV);
      Eigen::Matrix3d u = svd.matrixU();
      if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) *= -1.0;
      columns.middleRows<3>(3 * v) = (u * svd.matrixV().transpose()).transpose();
    }
    return columns;
  }

  Places carried_rotations(const SurfaceStep& step) const {
    Places columns(3 * static_cast<Eigen::Index>(surface.vertex_count), 3);
    for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
      glm::dquat turned(1.0, 0.0, 0.0, 0.0);
      for (std::size_t k = 0; k < 4 && !surface.carry.empty(); ++k) {
        const double weight = static_cast<double>(surface.carry[v].weight[k]);
        if (!(weight > 0.0)) continue;
        const RigidMotion motion{glm::mat4(1.0f), step.carriers[surface.carry[v].carrier[k]].to};
        turned = glm::normalize(glm::quat_cast(glm::dmat3(part_of(motion, weight)))) * turned;
      }
      const glm::dmat3 rotation = glm::mat3_cast(turned);
      for (int k = 0; k < 3; ++k) columns.row(3 * static_cast<Eigen::Index>(v) + k) << rotation[k].x, rotation[k].y, rotation[k].z;
    }
    return columns;
  }

  // Targets of the direction's rows.
  Places direction_targets(std::span<const glm::vec3> line) const {
    Places targets(rows.rows(), 3);
    const double weight = std::sqrt(static_cast<double>(hull.settings.direction) * static_cast<double>(hull.direction.along.size()));
    for (Eigen::Index i = 0; i < targets.rows(); ++i) {
      const auto part = static_cast<std::size_t>(i);
      const Eigen::Vector3d before = to_eigen(hull.direction.line[part]);
      const Eigen::Vector3d now = to_eigen(place_along(line, hull.direction.along[part + 1]) -
                                           place_along(line, hull.direction.along[part]));
      const Eigen::Vector3d rest = to_eigen(hull.direction.rest[part]);
      const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(before, now);
      targets.row(i) = (weight * now.norm() / before.norm() * (turn * rest)).transpose();
    }
    return targets;
  }
};

PoseReference::PoseReference(const SurfaceAsset& surface, const HullAsset& hull)
    : parts_(std::make_unique<const Parts>(surface, hull)) {}

PoseReference::~PoseReference() = default;

HullPose PoseReference::pose(const SurfaceStep& step, const HullSettings& settings,
                             std::span<const glm::vec3> line) const {
  const Parts& parts = *parts_;
  const SurfaceAsset& surface = parts.surface;
  Places constant = Places::Zero(surface.vertex_count, 3);
  for (const AttachedVertex& attached : surface.attached) {
    const Eigen::Vector3d rest = parts.energy.rest.row(attached.vertex).transpose();
    constant.row(attached.vertex) = kAttachmentWeight * apply(step.attachments[attached.attachment].to, rest).transpose();
  }
  if (parts.rows.rows() > 0) constant += parts.rows.transpose() * parts.direction_targets(line);

  HullPose pose;
  Places places = parts.energy.rest, rotations = parts.carried_rotations(step), gradient;
  while (pose.iterations < kMostIterations && !pose.converged) {
    Places next = parts.solve(parts.loads * rotations + constant);
    for (int i = 0; i < 3; ++i) {  // the volume: a multiplier, its row taken anew
      const double lack = surface.volume - volume_of(surface.triangles, next, &gradient);
      const Places along = parts.solve(gradient);
      next += lack / gradient.cwiseProduct(along).sum() * along;
    }
    for (std::size_t b = 0; b < step.bones.size() && step.settings.collide_with_bones; ++b) {
      if (step.fields[b] == nullptr) continue;
      const glm::mat4 to_bone(glm::dmat4(step.rest_to_bone[b]) * glm::inverse(glm::dmat4(step.bones[b].to)));
      const glm::mat4 from_bone = glm::inverse(to_bone);
      for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
        if (!(surface.rest[v].inverse_mass > 0.0f)) continue;
        const Eigen::Vector3d q = apply(to_bone, next.row(v).transpose());
        const FieldValue value = step.fields[b]->at({static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z())});
        const float depth = step.settings.contact_distance - value.distance;
        if (depth > 0.0f) next.row(v) += to_eigen(glm::mat3(from_bone) * (depth * value.gradient)).transpose();
      }
    }
    const double moved = (next - places).rowwise().norm().maxCoeff();
    places = next;
    rotations = parts.rotations_of(places);
    ++pose.iterations;
    pose.converged = moved <= static_cast<double>(settings.tolerance * surface.size);
  }
  for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
    step.points[v].x = static_cast<float>(places(v, 0));
    step.points[v].y = static_cast<float>(places(v, 1));
    step.points[v].z = static_cast<float>(places(v, 2));
  }
  pose.volume = volume_of(surface.triangles, places, nullptr);
  return pose;
}

double PoseReference::energy(std::span<const SurfacePoint> points) const {
  const Parts& parts = *parts_;
  Places places(parts.surface.vertex_count, 3);
  for (std::uint32_t v = 0; v < parts.surface.vertex_count; ++v) {
    places.row(v) << static_cast<double>(points[v].x), static_cast<double>(points[v].y), static_cast<double>(points[v].z);
  }
  const Places rotations = parts.rotations_of(places), &rest = parts.energy.rest;
  return places.cwiseProduct(Places(parts.matrix * places)).sum() +
         rest.cwiseProduct(Places(parts.matrix * rest)).sum() -
         2.0 * places.cwiseProduct(Places(parts.loads * rotations)).sum();
}

}  // namespace fascicle::muscle
