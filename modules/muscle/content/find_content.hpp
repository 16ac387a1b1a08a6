// Where content lies: the folder of characters and scenes that ships with the project, and the folder of real data
// that does not. Neither is compiled in as the only place, so that an installed program and a moved tree both work.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace fascicle::muscle {

// The content folder (it holds schema/, characters/ and scenes/): the environment variable FASCICLE_CONTENT, else
// ../share/fascicle/content beside the running program, else content/ in one of the folders above the program or
// above the current folder. Empty where there is none.
std::filesystem::path find_content_folder();

// The data folder that the prefix `data:` stands for: the environment variable FASCICLE_DATA, else shared/data beside
// the folder that holds the content folder. Empty where there is none.
std::filesystem::path find_data_folder();

// A scene by name ("walker": scenes/walker.scene.json in the content folder) or by path. The path is returned as
// given where it names an existing file or ends in .json; else it is looked up by name. It need not exist.
std::filesystem::path find_scene(std::string_view name_or_path, const std::filesystem::path& content_folder);

}  // namespace fascicle::muscle
