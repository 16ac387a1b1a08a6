#include "modules/muscle/content/find_content.hpp"

#include <cstdlib>
#include <system_error>

namespace fascicle::muscle {

namespace {

namespace fs = std::filesystem;

fs::path from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? fs::path(value) : fs::path();
}

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool holds_content(const fs::path& folder) { return is_folder(folder / "scenes") && is_folder(folder / "characters"); }

fs::path program_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path();
}

// content/ in `start` or in one of the folders above it.
fs::path find_above(fs::path start) {
  for (; !start.empty(); start = start.parent_path()) {
    if (holds_content(start / "content")) return start / "content";
    if (start == start.root_path()) break;
  }
  return {};
}

}  // namespace

fs::path find_content_folder() {
  if (const fs::path given = from_environment("FASCICLE_CONTENT"); !given.empty()) return given;
  const fs::path program = program_folder();
  if (!program.empty()) {
    const fs::path installed = program.parent_path() / "share" / "fascicle" / "content";
    if (holds_content(installed)) return installed;
    if (const fs::path found = find_above(program); !found.empty()) return found;
  }
  std::error_code error;
  const fs::path current = fs::current_path(error);
  return error ? fs::path() : find_above(current);
}

fs::path find_data_folder() {
  if (const fs::path given = from_environment("FASCICLE_DATA"); !given.empty()) {
    return is_folder(given) ? given : fs::path();
  }
  const fs::path content = find_content_folder();
  if (content.empty()) return {};
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(content, error);
  if (error) return {};
  // <project>/content and <project>/../shared/data.
  const fs::path data = absolute.parent_path().parent_path() / "shared" / "data";
  return is_folder(data) ? data : fs::path();
}

fs::path find_scene(std::string_view name_or_path, const fs::path& content_folder) {
  const fs::path given(name_or_path);
  std::error_code error;
  if (given.extension() == ".json" || fs::is_regular_file(given, error)) return given;
  return content_folder / "scenes" / (std::string(name_or_path) + ".scene.json");
}

}  // namespace fascicle::muscle
