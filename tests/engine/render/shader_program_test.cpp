#include "engine/render/shader_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/render/render_fixture.hpp"

namespace fascicle {
namespace {

using testing::HasSubstr;

class ShaderProgram : public RenderFixture {};

constexpr ShaderFile kFiles[] = {
    {"good.vert", "#include \"common.glsl\"\nvoid main() { gl_Position = vec4(one()); }\n"},
    {"bad.vert", "#include \"common.glsl\"\n\nvoid main() {\n  gl_Position = vec4(none());\n}\n"},
    {"bad_include.vert", "\n#include \"broken.glsl\"\nvoid main() { gl_Position = vec4(1.0); }\n"},
    {"lost_include.vert", "#include \"nowhere.glsl\"\nvoid main() {}\n"},
    {"endless.vert", "#include \"endless.vert\"\n"},
    {"mismatch.vert", "out vec2 a;\nvoid main() { a = vec2(0.0); gl_Position = vec4(1.0); }\n"},
    {"mismatch.frag", "in vec3 a;\nout vec4 c;\nvoid main() { c = vec4(a, 1.0); }\n"},
    {"common.glsl", "float one() {\n  return 1.0;\n}\n"},
    {"broken.glsl", "// fine\nfloat two() { return undeclared; }\n"},
    {"plain.frag", "out vec4 c;\nvoid main() { c = vec4(SHADE); }\n"},
};

std::string errors_of(std::string_view vertex, std::string_view fragment) {
  const Result<GlProgram> built = build_program(vertex, fragment, {"SHADE 0.5"}, kFiles);
  return built.ok() ? "" : to_text(built.diagnostics());
}

TEST_F(ShaderProgram, CompilesWithIncludesAndDefines) { EXPECT_EQ(errors_of("good.vert", "plain.frag"), ""); }

TEST_F(ShaderProgram, ErrorsNameFileAndLine) {
  EXPECT_THAT(errors_of("bad.vert", "plain.frag"), HasSubstr("engine/render/shaders/bad.vert:4: "));
  EXPECT_THAT(errors_of("bad_include.vert", "plain.frag"), HasSubstr("engine/render/shaders/broken.glsl:2: "));
  EXPECT_FALSE(log_->take_errors().empty()) << "the driver's log has them too";
}

TEST_F(ShaderProgram, MissingAndEndlessIncludesAreErrors) {
  EXPECT_THAT(errors_of("lost_include.vert", "plain.frag"), HasSubstr("nowhere.glsl: no such file"));
  EXPECT_THAT(errors_of("endless.vert", "plain.frag"), HasSubstr("includes itself"));
  EXPECT_THAT(errors_of("absent.vert", "plain.frag"), HasSubstr("absent.vert: no such file"));
}

TEST_F(ShaderProgram, LinkErrorsAreReported) {
  EXPECT_THAT(errors_of("mismatch.vert", "mismatch.frag"), HasSubstr("doesn't link with mismatch.frag"));
}

TEST_F(ShaderProgram, AllEmbeddedFilesAreThere) {
  EXPECT_EQ(shader_files().size(), 14u);
  for (const ShaderFile& file : shader_files()) EXPECT_GT(std::string_view(file.text).size(), 20u) << file.name;
}

}  // namespace
}  // namespace fascicle
