// Which fields the readers of content files know, written down as they ask for them: a test compares it with the JSON
// schemas, so that the editor's completion and the loader cannot drift apart.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "engine/content/json_reader.hpp"

namespace fascicle::muscle {

// Kind of object ("muscle", "profile") -> names of its fields.
using FieldLog = std::map<std::string, std::set<std::string>, std::less<>>;

// What a reader of content files hands down: where errors go, and the log where one is wanted (else null).
struct ReadContext {
  Diagnostics& diagnostics;
  FieldLog* fields = nullptr;
};

// Ends the reading of one object of the given kind: unknown members become errors, known ones enter the log.
inline void finish_object(JsonObject& object, std::string_view kind, const ReadContext& context) {
  object.finish();
  if (context.fields == nullptr) return;
  auto& known = (*context.fields)[std::string(kind)];
  for (const std::string_view name : object.known()) known.emplace(name);
}

}  // namespace fascicle::muscle
