// The file is an OpenVDB stream and after it, where OpenVDB does not look, a seal: a word to know it by, our version,
// the stream's length and its hash.
// OpenVDB's reader trusts what it reads, so nothing reaches it that was not sealed here.
#include "modules/muscle/asset/bone_fields/bone_grid_file.hpp"

#include <openvdb/io/Stream.h>

#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "engine/content/file_text.hpp"
#include "engine/math/state_hash.hpp"
#include "modules/muscle/asset/bone_fields/grid_state.hpp"

namespace fascicle::muscle {

namespace {

// Raise it whenever the same meshes would give another grid, or the file another form.
constexpr std::uint64_t kVersion = 6;

struct Seal {
  std::array<char, 16> word{'f', 'a', 's', 'c', 'i', 'c', 'l', 'e', ' ', 'b', 'o', 'n', 'e', 's', '\n', '\0'};
  std::uint64_t version = kVersion;
  std::uint64_t length = 0;  // bytes
  std::uint64_t hash = 0;
};
static_assert(sizeof(Seal) == 40);

std::uint64_t hash_bytes(std::string_view bytes) {
  StateHash hash;
  hash.add(std::span<const char>(bytes.data(), bytes.size()));
  return hash.value();
}

Seal seal_of(std::string_view stream) {
  Seal seal;
  seal.length = stream.size();
  seal.hash = hash_bytes(stream);
  return seal;
}

// The OpenVDB stream of a file that was written here and is whole.
std::optional<std::string> unsealed(std::string bytes) {
  if (bytes.size() < sizeof(Seal)) return std::nullopt;
  const std::size_t length = bytes.size() - sizeof(Seal);
  const Seal wanted = seal_of(std::string_view(bytes).substr(0, length));
  if (std::memcmp(&wanted, bytes.data() + length, sizeof(Seal)) != 0) return std::nullopt;
  bytes.resize(length);
  return bytes;
}

constexpr const char* kBone = "fascicle_bone";
constexpr const char* kInputs = "fascicle_inputs";
constexpr const char* kVoxel = "fascicle_voxel";
constexpr const char* kLower = "fascicle_lower";
constexpr const char* kUpper = "fascicle_upper";

openvdb::Vec3s to_vdb(const glm::vec3& v) { return {v.x, v.y, v.z}; }
glm::vec3 from_vdb(const openvdb::Vec3s& v) { return {v.x(), v.y(), v.z()}; }

// Throws where the grid is not one of ours.
StoredBoneGrid from_grid(const openvdb::GridBase::Ptr& base) {
  auto state = std::make_shared<BoneGrid::State>();
  state->grid = openvdb::gridConstPtrCast<openvdb::FloatGrid>(base);
  if (!state->grid) throw std::runtime_error("a grid of another type");
  state->voxel = base->metaValue<float>(kVoxel);
  if (!(state->voxel > 0.0f) || !std::isfinite(state->voxel)) throw std::runtime_error("a grid without a voxel");
  state->band = band_of(state->voxel);
  state->lower = from_vdb(base->metaValue<openvdb::Vec3s>(kLower));
  state->upper = from_vdb(base->metaValue<openvdb::Vec3s>(kUpper));
  const auto inputs = static_cast<std::uint64_t>(base->metaValue<std::int64_t>(kInputs));
  return {base->metaValue<std::string>(kBone), inputs, BoneGrid(std::move(state))};
}

}  // namespace

std::uint64_t hash_bone_inputs(std::span<const TriangleMesh> meshes, const BoneGridSettings& settings) {
  StateHash hash;
  hash.add(kVersion);
  hash.add(settings.voxel);
  for (const TriangleMesh& mesh : meshes) {
    hash.add(std::uint64_t{mesh.positions.size()});
    hash.add(std::span<const glm::vec3>(mesh.positions));
    hash.add(std::uint64_t{mesh.indices.size()});
    hash.add(std::span<const std::uint32_t>(mesh.indices));
  }
  return hash.value();
}

std::vector<StoredBoneGrid> read_bone_grids(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};  // a pipe could be read for ever
  try {
    Result<std::string> bytes = read_text_file(file);
    if (!bytes) return {};
    std::optional<std::string> stream = unsealed(std::move(*bytes));
    if (!stream) return {};
    start_openvdb();
    std::istringstream input(std::move(*stream), std::ios::binary);
    openvdb::io::Stream reader(input, /*delayLoad=*/false);
    std::vector<StoredBoneGrid> grids;
    for (const openvdb::GridBase::Ptr& grid : *reader.getGrids()) grids.push_back(from_grid(grid));
    return grids;
  } catch (const std::exception&) {  // OpenVDB's errors: the file is sealed, but by another OpenVDB
    return {};
  }
}

bool write_bone_grids(const std::filesystem::path& file, std::span<const StoredBoneGrid> grids) {
  try {
    start_openvdb();
    openvdb::GridPtrVec stored;
    for (const StoredBoneGrid& bone : grids) {
      const BoneGrid::State& state = bone.grid.state();
      const openvdb::FloatGrid::Ptr grid = openvdb::ConstPtrCast<openvdb::FloatGrid>(state.grid->copy());
      grid->setName(bone.bone);
      grid->insertMeta(kBone, openvdb::StringMetadata(bone.bone));
      grid->insertMeta(kInputs, openvdb::Int64Metadata(static_cast<std::int64_t>(bone.inputs)));
      grid->insertMeta(kVoxel, openvdb::FloatMetadata(state.voxel));
      grid->insertMeta(kLower, openvdb::Vec3SMetadata(to_vdb(state.lower)));
      grid->insertMeta(kUpper, openvdb::Vec3SMetadata(to_vdb(state.upper)));
      stored.push_back(grid);
    }
    std::ostringstream output(std::ios::binary);
    openvdb::io::Stream writer(output);
    writer.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_BLOSC);
    writer.write(stored);
    std::string bytes = std::move(output).str();
    const Seal seal = seal_of(bytes);
    bytes.append(reinterpret_cast<const char*>(&seal), sizeof(Seal));
    return write_text_atomically(file, bytes).ok();
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace fascicle::muscle
