#include "engine/geometry/mesh_pieces.hpp"

#include <gmock/gmock.h>

namespace fascicle {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(MeshPieces, AnEmptyMeshHasNone) {
  const MeshPieces pieces = find_pieces({}, 0);
  EXPECT_EQ(pieces.count, 0u);
  EXPECT_THAT(pieces.piece, IsEmpty());
}

// Two triangles with a common edge, one that shares only a vertex with them, and one far away, in mixed order.
TEST(MeshPieces, HangTogetherByEdgesAndNotByVertices) {
  const std::vector<std::uint32_t> indices = {0, 1, 2, 7, 8, 9, 2, 1, 3, 3, 4, 5};
  const MeshPieces pieces = find_pieces(indices, 10);
  EXPECT_EQ(pieces.count, 3u);
  EXPECT_THAT(pieces.piece, ElementsAre(0, 1, 0, 2));
}

// An edge with three triangles joins none of them: nobody could say which two belong together.
TEST(MeshPieces, ACrowdedEdgeJoinsNothing) {
  const std::vector<std::uint32_t> indices = {0, 1, 2, 1, 0, 3, 0, 1, 4};
  EXPECT_THAT(find_pieces(indices, 5).piece, ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace fascicle
