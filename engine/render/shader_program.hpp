// Compiles and links shader programs from the files in engine/render/shaders, which the library holds as text.
// A file may `#include "other"` (a line of its own); messages of the compiler are led back to file and line.
#pragma once

#include <initializer_list>
#include <span>
#include <string_view>

#include "engine/content/result.hpp"
#include "engine/render/gl_objects.hpp"

namespace fascicle {

struct ShaderFile {
  const char* name;
  const char* text;
};

// All embedded files.
std::span<const ShaderFile> shader_files();

// Compiles `vertex` and `fragment` with each of `defines` set, and links them. Errors, one a compiler message:
// file, line, what the driver said. `files` is where names are looked up.
Result<GlProgram> build_program(std::string_view vertex, std::string_view fragment,
                                std::initializer_list<std::string_view> defines = {},
                                std::span<const ShaderFile> files = shader_files());

}  // namespace fascicle
