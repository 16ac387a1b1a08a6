// OpenSim's function elements.
#pragma once

#include "engine/animation/scalar_function.hpp"
#include "modules/muscle/import/xml_fields.hpp"

namespace fascicle::muscle {

// The function element among `owner`'s children or inside its child `wrapper` ("function", "x_location"): a null node
// where there is none.
pugi::xml_node find_function(pugi::xml_node owner, const char* wrapper);

// Appends an error and returns false where the element is no function known here, or a wrong one.
bool read_function(XmlFields& fields, pugi::xml_node node, ScalarFunction& out);

}  // namespace fascicle::muscle
