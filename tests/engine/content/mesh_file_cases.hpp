// What the tests of mesh readers share: broken texts with their messages, numbers as bytes, files that VTK wrote.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle::test {

inline std::string with(std::string text, const std::string& find, const std::string& replacement) {
  const std::size_t at = text.find(find);
  EXPECT_NE(at, std::string::npos) << find;
  return text.replace(at, find.size(), replacement);
}

struct Broken {
  std::string text;
  std::string message;
};

template <class Parse>
void expect_messages(std::span<const Broken> cases, Parse parse) {
  for (const Broken& broken : cases) {
    const auto result = parse(broken.text);
    EXPECT_FALSE(result.ok()) << broken.message;
    EXPECT_THAT(to_text(result.diagnostics()), testing::HasSubstr(broken.message));
  }
}

// A file cut anywhere is refused, or holds what it held, less what stood behind the cut.
template <class Parse>
void expect_cuts_are_survived(const std::string& text, Parse parse) {
  const std::size_t whole = parse(text)->indices.size();
  for (std::size_t size = 0; size < text.size(); ++size) {
    const auto result = parse(text.substr(0, size));
    if (result) {
      EXPECT_LE(result->indices.size(), whole);
    } else {
      EXPECT_FALSE(result.diagnostics().errors.empty());
    }
  }
}

template <class T>
std::string bytes_of(std::initializer_list<T> numbers, std::endian order) {
  std::string bytes;
  for (const T number : numbers) {
    char copy[sizeof(T)];
    std::memcpy(copy, &number, sizeof(T));
    if (order != std::endian::native) std::reverse(copy, copy + sizeof(T));
    bytes.append(copy, sizeof(T));
  }
  return bytes;
}

// The corner of a cube, as VTK wrote it in many variants: seeds of the fuzzers.
template <class Read>
void expect_seeds_are_tetrahedra(const std::string& fuzzer, std::initializer_list<const char*> files, Read read) {
  for (const char* file : files) {
    const Result<TriangleMesh> mesh =
        read(std::filesystem::path(FASCICLE_SOURCE_DIR) / "tests/fuzz/corpus" / fuzzer / file);
    ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
    EXPECT_EQ(mesh->name, std::filesystem::path(file).stem().string());
    std::vector<glm::vec3> corners;
    for (const std::uint32_t index : mesh->indices) corners.push_back(mesh->positions.at(index));
    const glm::vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    EXPECT_THAT(corners, testing::ElementsAre(o, y, x, o, x, z, o, z, y, x, y, z)) << file;
  }
}

}  // namespace fascicle::test
