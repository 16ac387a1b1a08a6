#include "engine/render/shader_program.hpp"

#include <cctype>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace fascicle {
namespace {

constexpr int kMaxIncludeDepth = 8;

struct Source {
  std::string text;
  std::vector<std::string> files;  // by the source string number of #line
};

Diagnostic shader_error(std::string_view file, int line, const std::string& cause) {
  return {fmt::format("engine/render/shaders/{}", file), line, 0, "", cause, "correct the shader"};
}

const ShaderFile* find_file(std::span<const ShaderFile> files, std::string_view name) {
  for (const ShaderFile& file : files) {
    if (name == file.name) return &file;
  }
  return nullptr;
}

// Appends a file's text with its includes in place, each stretch led by #line.
void append_file(std::string_view name, std::span<const ShaderFile> files, int depth, Source& source,
                 Diagnostics& problems) {
  const ShaderFile* file = find_file(files, name);
  const auto number = source.files.size();
  source.files.emplace_back(name);
  if (file == nullptr || depth > kMaxIncludeDepth) {
    problems.errors.push_back(shader_error(name, 0, file == nullptr ? "no such file" : "includes itself"));
    return;
  }
  source.text += fmt::format("#line 1 {}\n", number);
  std::string_view rest = file->text;
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    constexpr std::string_view kInclude = "#include \"";
    if (line.starts_with(kInclude)) {
      const std::string_view included = line.substr(kInclude.size(), line.rfind('"') - kInclude.size());
      append_file(included, files, depth + 1, source, problems);
      source.text += fmt::format("#line {} {}\n", line_number + 1, number);
    } else {
      source.text += line;
      source.text += '\n';
    }
  }
}

// Drivers write "0:12(5): error: text" (Mesa), "0(12) : error C1: text" (NVIDIA), "ERROR: 0:12: text" (others).
Diagnostic read_message(std::string_view message, const Source& source) {
  std::vector<int> numbers;
  for (std::size_t i = 0; i < message.size() && numbers.size() < 2; ++i) {
    if (std::isdigit(static_cast<unsigned char>(message[i])) == 0) continue;
    int value = 0;
    for (; i < message.size() && std::isdigit(static_cast<unsigned char>(message[i])) != 0; ++i) {
      value = value < 1'000'000 ? value * 10 + (message[i] - '0') : value;
    }
    numbers.push_back(value);
  }
  if (numbers.size() == 2 && static_cast<std::size_t>(numbers[0]) < source.files.size()) {
    return shader_error(source.files[static_cast<std::size_t>(numbers[0])], numbers[1], std::string(message));
  }
  return shader_error(source.files.front(), 0, std::string(message));
}

void append_messages(std::string_view log, const Source& source, Diagnostics& problems) {
  const std::size_t before = problems.errors.size();
  while (!log.empty()) {
    const std::size_t end = log.find('\n');
    const std::string_view line = log.substr(0, end);
    log = end == std::string_view::npos ? std::string_view() : log.substr(end + 1);
    if (line.find("error") != std::string_view::npos || line.find("ERROR") != std::string_view::npos) {
      problems.errors.push_back(read_message(line, source));
    }
  }
  if (problems.errors.size() == before) {
    problems.errors.push_back(shader_error(source.files.front(), 0, "the driver refused it without a message"));
  }
}

GLuint compile(GLenum stage, std::string_view name, std::initializer_list<std::string_view> defines,
               std::span<const ShaderFile> files, Diagnostics& problems) {
  Source source;
  source.text = "#version 450 core\n";
  for (const std::string_view define : defines) source.text += fmt::format("#define {}\n", define);
  Diagnostics include_problems;
  append_file(name, files, 0, source, include_problems);
  if (!include_problems.ok()) {
    problems.append(std::move(include_problems));
    return 0;
  }
  const GLuint shader = glCreateShader(stage);
  const char* text = source.text.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  std::string log(8192, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
  append_messages(std::string_view(log).substr(0, static_cast<std::size_t>(length)), source, problems);
  glDeleteShader(shader);
  return 0;
}

}  // namespace

Result<GlProgram> build_program(std::string_view vertex, std::string_view fragment,
                                std::initializer_list<std::string_view> defines, std::span<const ShaderFile> files) {
  Diagnostics problems;
  const GLuint vertex_shader = compile(GL_VERTEX_SHADER, vertex, defines, files, problems);
  const GLuint fragment_shader = compile(GL_FRAGMENT_SHADER, fragment, defines, files, problems);
  GlProgram program;
  if (problems.ok()) {
    program = GlProgram(glCreateProgram());
    glAttachShader(program.name(), vertex_shader);
    glAttachShader(program.name(), fragment_shader);
    glLinkProgram(program.name());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
      std::string log(8192, '\0');
      GLsizei length = 0;
      glGetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), &length, log.data());
      log.resize(static_cast<std::size_t>(length));
      problems.errors.push_back(shader_error(vertex, 0, fmt::format("doesn't link with {}: {}", fragment, log)));
    }
  }
  glDeleteShader(vertex_shader);
  glDeleteShader(fragment_shader);
  if (!problems.ok()) return problems;
  return program;
}

}  // namespace fascicle
