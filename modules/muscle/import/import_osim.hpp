// OpenSim models as characters: the text of a character file (content/schema/character.schema.json, version 1) with
// the model's joints, bone meshes and muscles. Attachments are the model's own figures in its bodies' frames.
//
// A character's path has fixed points only. Conditional points are taken in the state that they have at the
// coordinates' defaults (kept where active, left out where not), moving points at their place there, and wrap objects
// are left out: one warning a muscle says which.
#pragma once

#include <filesystem>
#include <string>

#include "engine/content/result.hpp"
#include "modules/muscle/import/osim_model.hpp"

namespace fascicle::muscle {

struct ImportOptions {
  std::string name;                        // of the character; empty: the model's
  std::filesystem::path
      geometry_folder;          // where the bone meshes are; those that aren't there are left out, with a warning
  std::string geometry_prefix;  // put before a mesh's file name in the character file ("data:opensim/Geometry/")
  std::string schema = "../../schema/character.schema.json";
  std::string source;                      // where the model is from; empty: its name, file and credits
  std::string licence;                     // empty: what the credits say, where they name a Creative Commons licence
  double specific_tension = 610000.0;      // N/m^2: turns maximum isometric forces into cross sections
};

// Errors: a muscle without force or whose points all lie in one place. The text ends with a line break, and is the same
// for the same input.
Result<std::string> import_character(const OsimModel& model, const ImportOptions& options);

// "CC BY 3.0" from a model's credits; empty where they name no such licence.
std::string find_licence(const std::string& credits);

}  // namespace fascicle::muscle
