# Makes a C++ source that holds the shader files as text.
# cmake -DOUTPUT=file.cpp -DFOLDER=.../shaders -DFILES="a.vert,b.frag" -P embed_shaders.cmake
string(REPLACE "," ";" files "${FILES}")
set(code "// Made from the files in engine/render/shaders; don't edit.\n")
string(APPEND code "#include \"engine/render/shader_program.hpp\"\n\n")
string(APPEND code "namespace fascicle {\n\nstd::span<const ShaderFile> shader_files() {\n")
string(APPEND code "  static constexpr ShaderFile kFiles[] = {\n")
foreach(file IN LISTS files)
  file(READ "${FOLDER}/${file}" text)
  string(APPEND code "    {\"${file}\", R\"glsl(${text})glsl\"},\n")
endforeach()
string(APPEND code "  };\n  return kFiles;\n}\n\n}  // namespace fascicle\n")
file(WRITE "${OUTPUT}" "${code}")
